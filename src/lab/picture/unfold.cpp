#include "lab/picture/unfold.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

// Where a slice's square stands in the picture, in squares.
glm::ivec2 placeOf(const FittedMap& fitted, int slice) {
  return fitted.unfoldedAt.empty() ? glm::ivec2(slice, 0) : fitted.unfoldedAt[static_cast<size_t>(slice)];
}

// The tangent of half the solid angle of a spherical triangle.
double halfAngleTangent(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double& numerator,
                        double& denominator) {
  numerator = std::abs(glm::dot(a, glm::cross(b, c)));
  denominator = 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a);
  return numerator / denominator;
}

constexpr int kRowsTogether = 32;  // of texels, one thread's
constexpr SolidAngles kNoAngles{.smallest = 1e30};

// Unit rays through the corners of texels, one line of them.
using CornerRow = std::vector<glm::dvec3>;

CornerRow cornerRow(const glsl::ShadowMap& map, int slice, int y) {
  CornerRow corners(static_cast<size_t>(map.width) + 1);
  for (int x = 0; x <= map.width; ++x) {
    const glm::vec2 uv = glm::vec2(x, y) / static_cast<float>(map.width);
    corners[static_cast<size_t>(x)] = glm::normalize(glm::dvec3(glsl::mapTexelRay(map, slice, uv).dir));
  }
  return corners;
}

// Adds a texel of two triangles. Its angle is 2 (atan t1 + atan t2), and an arc tangent costs more than all else; but
// t - t^3/3 <= atan t <= t where t >= 0, and a texel that by this is neither the smallest nor the largest counts in the
// sum alone.
void addTexel(SolidAngles& angles, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  constexpr double kSmall = 1e-2;      // t^5/5 is then below 1e-8 of t
  constexpr double kRounding = 1e-12;  // of t, generously
  double n1, d1, n2, d2;
  const double t1 = halfAngleTangent(a, b, c, n1, d1);
  const double t2 = halfAngleTangent(b, c, d, n2, d2);
  const double above = 2.0 * (t1 + t2);
  const double below = above - 2.0 / 3.0 * (t1 * t1 * t1 + t2 * t2 * t2);
  const bool small = t1 >= 0.0 && t1 < kSmall && t2 >= 0.0 && t2 < kSmall;
  if (small && below * (1.0 - kRounding) > angles.smallest && above * (1.0 + kRounding) < angles.largest) {
    angles.sum += below;
    return;
  }
  const double angle = 2.0 * std::atan2(n1, d1) + 2.0 * std::atan2(n2, d2);
  angles.smallest = std::min(angles.smallest, angle);
  angles.largest = std::max(angles.largest, angle);
  angles.sum += angle;
}

// Of rows that follow one another, counted through all slices.
SolidAngles anglesOfRows(const glsl::ShadowMap& map, int begin, int end) {
  SolidAngles angles = kNoAngles;
  CornerRow above, below;
  for (int row = begin; row < end; ++row) {
    const int slice = row / map.width;
    const int y = row % map.width;
    above = row == begin || y == 0 ? cornerRow(map, slice, y) : std::move(below);
    below = cornerRow(map, slice, y + 1);
    for (int x = 0; x < map.width; ++x) {
      const auto i = static_cast<size_t>(x);
      if (glsl::mapHoldsTexel(map, slice, {x, y})) addTexel(angles, above[i], above[i + 1], below[i], below[i + 1]);
    }
  }
  return angles;
}

}  // namespace

Image8 unfoldedPicture(const Image8& layers, const FittedMap& fitted, const glm::u8vec3& outside) {
  const glsl::ShadowMap& map = fitted.map;
  const int side = map.width;
  glm::ivec2 squares(1);
  for (int slice = 0; slice < map.sliceCount; ++slice) squares = glm::max(squares, placeOf(fitted, slice) + 1);
  Image8 picture(squares.x * side, squares.y * side, 3);
  for (size_t i = 0; i < picture.values.size(); ++i) picture.values[i] = outside[static_cast<int>(i % 3)];
  for (int slice = 0; slice < map.sliceCount; ++slice) {
    const glm::ivec2 corner = placeOf(fitted, slice) * side;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        if (glsl::mapHoldsTexel(map, slice, {x, y}))
          std::copy_n(layers.at(slice * side + x, y), 3, picture.at(corner.x + x, corner.y + y));
  }
  return picture;
}

std::optional<SolidAngles> computeSolidAngles(const FittedMap& fitted) {
  if (!fitted.positional) return std::nullopt;
  const glsl::ShadowMap& map = fitted.map;
  const int rowCount = map.sliceCount * map.width;
  std::vector<SolidAngles> parts(static_cast<size_t>((rowCount + kRowsTogether - 1) / kRowsTogether));
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t part) {
    const int begin = static_cast<int>(part) * kRowsTogether;
    parts[part] = anglesOfRows(map, begin, std::min(begin + kRowsTogether, rowCount));
  });
  SolidAngles angles = kNoAngles;
  for (const SolidAngles& part : parts) {
    angles.smallest = std::min(angles.smallest, part.smallest);
    angles.largest = std::max(angles.largest, part.largest);
    angles.sum += part.sum;
  }
  return angles;
}

}  // namespace gnomon
