// The unfolded picture is of one piece, and texels' solid angles are those of the sphere.
#include "lab/picture/unfold.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

FittedMap cube(int side) {
  return makeCubeMap(glm::dvec3(0.0), CubeDepth::Radial, 0.1, 10.0, side, 10.0f);
}

// Every texel's own direction as a colour.
Image8 directions(const FittedMap& fitted) {
  const int side = fitted.map.width;
  Image8 image(side * fitted.map.sliceCount, side, 3);
  for (int slice = 0; slice < fitted.map.sliceCount; ++slice) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const glm::vec3 dir = glsl::mapTexelRay(fitted.map, slice, glsl::mapTexelCenter(fitted.map, {x, y})).dir;
        for (int c = 0; c < 3; ++c)
          image.at(slice * side + x, y)[c] = static_cast<uint8_t>(std::lround(127.0f + 127.0f * dir[c]));
      }
    }
  }
  return image;
}

// Neighbours in the cross look in neighbouring directions: no face stands on its head or beside a stranger.
TEST(Unfold, TheCrossIsOfOnePiece) {
  constexpr int kSide = 64;
  const FittedMap fitted = cube(kSide);
  const glm::u8vec3 outside(0, 0, 0);
  const Image8 picture = unfoldedPicture(directions(fitted), fitted, outside);
  ASSERT_EQ(picture.width, 4 * kSide);
  ASSERT_EQ(picture.height, 3 * kSide);
  const auto at = [&](int x, int y) {
    const uint8_t* p = picture.at(x, y);
    return glm::ivec3(p[0], p[1], p[2]);
  };
  size_t drawn = 0;
  for (int y = 0; y + 1 < picture.height; ++y) {
    for (int x = 0; x + 1 < picture.width; ++x) {
      if (at(x, y) == glm::ivec3(0)) continue;
      ++drawn;
      for (const glm::ivec3 next : {at(x + 1, y), at(x, y + 1)}) {
        // The largest texel is 2/64 radians wide: four steps of 1/127.
        if (next != glm::ivec3(0)) {
          ASSERT_LE(glm::length(glm::vec3(next - at(x, y))), 7.0f) << x << " " << y;
        }
      }
    }
  }
  EXPECT_GT(drawn, size_t{6 * kSide * kSide - 8 * kSide});
}

TEST(Unfold, SolidAnglesOfACubeAreTheSphere) {
  const SolidAngles angles = *computeSolidAngles(cube(128));
  EXPECT_NEAR(angles.sum, 4.0 * std::numbers::pi, 1e-4);
  // A texel at a corner is sqrt(3) as far and seen as obliquely: 3 sqrt(3) = 5.196 times smaller than at the middle.
  EXPECT_NEAR(angles.largest / angles.smallest, 3.0 * std::sqrt(3.0), 0.15);
}

// To the bit: an estimate may only spare what is neither.
TEST(Unfold, TheSmallestAndTheLargestAngleAreThoseOfAllTexels) {
  const auto triangle = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return 2.0 *
           std::atan2(std::abs(glm::dot(a, glm::cross(b, c))), 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
  };
  for (const FittedMap& fitted :
       {cube(3), cube(75),
        makeParaboloidMap(glm::dvec3(0.0), {0.3, -1, 0.2}, ParaboloidRaster::Exact, 0.1, 10.0, 90, 10.0f)}) {
    const int side = fitted.map.width;
    SolidAngles expected{.smallest = 1e30};
    for (int slice = 0; slice < fitted.map.sliceCount; ++slice)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          if (!glsl::mapHoldsTexel(fitted.map, slice, {x, y})) continue;
          std::array<glm::dvec3, 4> at;
          for (int i = 0; i < 4; ++i) {
            const glm::vec2 uv = glm::vec2(x + (i & 1), y + (i >> 1)) / static_cast<float>(side);
            at[static_cast<size_t>(i)] = glm::normalize(glm::dvec3(glsl::mapTexelRay(fitted.map, slice, uv).dir));
          }
          const double angle = triangle(at[0], at[1], at[2]) + triangle(at[1], at[2], at[3]);
          expected.smallest = std::min(expected.smallest, angle);
          expected.largest = std::max(expected.largest, angle);
          expected.sum += angle;
        }
    const SolidAngles angles = *computeSolidAngles(fitted);
    EXPECT_EQ(angles.smallest, expected.smallest) << side;
    EXPECT_EQ(angles.largest, expected.largest) << side;
    EXPECT_NEAR(angles.sum, expected.sum, 1e-7 * expected.sum) << side;
  }
}

TEST(Unfold, SolidAnglesOfAParaboloidAreTheSphereAndItsRim) {
  const FittedMap fitted =
      makeParaboloidMap(glm::dvec3(0.0), {0, -1, 0}, ParaboloidRaster::Exact, 0.1, 10.0, 256, 10.0f);
  const SolidAngles angles = *computeSolidAngles(fitted);
  // Texels on the rim are in both layers: a band of at most a texel's width, 2 pi * 2/256 * 2 steradians.
  EXPECT_GT(angles.sum, 4.0 * std::numbers::pi);
  EXPECT_LT(angles.sum, 4.0 * std::numbers::pi + 4.0 * std::numbers::pi * 2.0 / 256.0);
  EXPECT_NEAR(angles.largest / angles.smallest, 4.0, 0.1);  // the middle against the rim
}

TEST(Unfold, OutsideTheDiscsIsMarked) {
  const FittedMap fitted =
      makeParaboloidMap(glm::dvec3(0.0), {0, -1, 0}, ParaboloidRaster::Exact, 0.1, 10.0, 64, 10.0f);
  const Image8 picture = unfoldedPicture(Image8(128, 64, 3, 200), fitted, {1, 2, 3});
  EXPECT_EQ(picture.at(0, 0)[1], 2);
  EXPECT_EQ(picture.at(32, 32)[1], 200);
  EXPECT_EQ(picture.at(127, 63)[2], 3);
}

}  // namespace
}  // namespace gnomon
