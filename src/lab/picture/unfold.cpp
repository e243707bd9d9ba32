#include "lab/picture/unfold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

// Where a layer's square stands in the picture, in squares.
glm::ivec2 placeOf(const FittedMap& fitted, int layer) {
  return fitted.unfoldedAt.empty() ? glm::ivec2(layer, 0) : fitted.unfoldedAt[static_cast<size_t>(layer)];
}

double solidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double numerator = std::abs(glm::dot(a, glm::cross(b, c)));
  return 2.0 * std::atan2(numerator, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

constexpr int kRowsTogether = 32;  // of texels, one thread's
constexpr SolidAngles kNoAngles{.smallest = 1e30};

// Unit rays through the corners of texels, one line of them.
using CornerRow = std::vector<glm::dvec3>;

CornerRow cornerRow(const glsl::ShadowMap& map, int layer, int y) {
  CornerRow corners(static_cast<size_t>(map.side) + 1);
  for (int x = 0; x <= map.side; ++x) {
    const glm::vec2 uv = glm::vec2(x, y) / static_cast<float>(map.side);
    corners[static_cast<size_t>(x)] = glm::normalize(glm::dvec3(glsl::mapTexelRay(map, layer, uv).dir));
  }
  return corners;
}

SolidAngles anglesOfRow(const glsl::ShadowMap& map, int layer, int y, const CornerRow& above, const CornerRow& below) {
  SolidAngles angles = kNoAngles;
  for (int x = 0; x < map.side; ++x) {
    if (!glsl::mapHoldsTexel(map, layer, {x, y})) continue;
    const auto i = static_cast<size_t>(x);
    const double angle =
        solidAngle(above[i], above[i + 1], below[i]) + solidAngle(above[i + 1], below[i], below[i + 1]);
    angles.smallest = std::min(angles.smallest, angle);
    angles.largest = std::max(angles.largest, angle);
    angles.sum += angle;
  }
  return angles;
}

}  // namespace

Image8 unfoldedPicture(const Image8& layers, const FittedMap& fitted, const glm::u8vec3& outside) {
  const glsl::ShadowMap& map = fitted.map;
  const int side = map.side;
  glm::ivec2 squares(1);
  for (int layer = 0; layer < map.layerCount; ++layer) squares = glm::max(squares, placeOf(fitted, layer) + 1);
  Image8 picture(squares.x * side, squares.y * side, 3);
  for (size_t i = 0; i < picture.values.size(); ++i) picture.values[i] = outside[static_cast<int>(i % 3)];
  for (int layer = 0; layer < map.layerCount; ++layer) {
    const glm::ivec2 corner = placeOf(fitted, layer) * side;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        if (glsl::mapHoldsTexel(map, layer, {x, y}))
          std::copy_n(layers.at(layer * side + x, y), 3, picture.at(corner.x + x, corner.y + y));
  }
  return picture;
}

std::optional<SolidAngles> computeSolidAngles(const FittedMap& fitted) {
  if (!fitted.positional) return std::nullopt;
  const glsl::ShadowMap& map = fitted.map;
  // Opposite faces of a cube differ by signs alone, and the signs of a texel's corners by no bit of its angle.
  const int every = isCube(map) ? 2 : 1;
  std::vector<SolidAngles> rows(static_cast<size_t>(map.layerCount / every) * static_cast<size_t>(map.side));
  tbb::parallel_for(tbb::blocked_range<int>(0, static_cast<int>(rows.size()), kRowsTogether),
                    [&](const tbb::blocked_range<int>& range) {
                      CornerRow above, below;
                      for (int row = range.begin(); row < range.end(); ++row) {
                        const int layer = row / map.side * every;
                        const int y = row % map.side;
                        above = row == range.begin() || y == 0 ? cornerRow(map, layer, y) : std::move(below);
                        below = cornerRow(map, layer, y + 1);
                        rows[static_cast<size_t>(row)] = anglesOfRow(map, layer, y, above, below);
                      }
                    });
  SolidAngles angles = kNoAngles;
  for (const SolidAngles& row : rows) {
    angles.smallest = std::min(angles.smallest, row.smallest);
    angles.largest = std::max(angles.largest, row.largest);
    angles.sum += every * row.sum;
  }
  return angles;
}

}  // namespace gnomon
