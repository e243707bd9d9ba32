#include "lab/picture/unfold.h"

#include <algorithm>
#include <array>
#include <cmath>

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
  SolidAngles angles{.smallest = 1e30};
  for (int layer = 0; layer < map.layerCount; ++layer) {
    for (int y = 0; y < map.side; ++y) {
      for (int x = 0; x < map.side; ++x) {
        if (!glsl::mapHoldsTexel(map, layer, {x, y})) continue;
        std::array<glm::dvec3, 4> corners;
        for (int i = 0; i < 4; ++i) {
          const glm::vec2 uv = glm::vec2(x + (i & 1), y + (i >> 1)) / static_cast<float>(map.side);
          corners[static_cast<size_t>(i)] = glm::normalize(glm::dvec3(glsl::mapTexelRay(map, layer, uv).dir));
        }
        const double angle =
            solidAngle(corners[0], corners[1], corners[2]) + solidAngle(corners[1], corners[2], corners[3]);
        angles.smallest = std::min(angles.smallest, angle);
        angles.largest = std::max(angles.largest, angle);
        angles.sum += angle;
      }
    }
  }
  return angles;
}

}  // namespace gnomon
