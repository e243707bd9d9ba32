// Density against windows whose texels are known, and against counting texels.
#include "judge/texel_density.h"
#include "tests/shadow/seen_scene.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

using test::SeenScene;

// A sun of elevation e on a floor: a texel of a by b metres across the light covers a b / sin e of it.
TEST(TexelDensity, OfASunOnAFloorIsTheWindowsTexelsTimesTheSine) {
  for (const double elevation : {90.0, 40.0, 15.0}) {
    const SeenScene seen = test::see(test::longFloor(), test::alongTheFloor(), test::sun(elevation, 60.0), 32);
    const FittedMap fitted = seen.fit(directionalParameterization(), {kSnap(false)}, 512);
    // The window's own size, from the scale of its matrix: 2 / extent.
    const glm::mat4& m = fitted.map.mapSlices[0].clipFromLight;
    const double texels = 0.25 * std::abs(static_cast<double>(m[0][0]) * static_cast<double>(m[1][1])) * 512 * 512;
    size_t onTheFloor = 0;
    for (size_t i = 0; i < seen.receivers.states.size(); ++i) {
      const SurfaceSample& sample = seen.receivers.samples[i];
      if (seen.receivers.states[i] != PixelState::Scored || sample.normalW.y < 0.999) continue;
      const auto density = texelDensity(fitted, sample.positionW, sample.normalW);
      ASSERT_TRUE(density.has_value());
      // A ray's ends round to 2^-24 of some 100 m, 6e-6 of texels of 0.05 to 0.3 m.
      EXPECT_NEAR(*density / (texels * std::sin(glm::radians(elevation))), 1.0, 2e-3);
      ++onTheFloor;
    }
    EXPECT_GT(onTheFloor, size_t{32 * 32 / 4}) << elevation;
  }
}

// Texels that a square metre of floor meets, counted.
TEST(TexelDensity, IsTheNumberOfTexelsOnASquareMetre) {
  const SeenScene seen = test::see(test::longFloor(), test::alongTheFloor(), test::sun(50.0, 60.0), 64);
  for (const Warp warp : {Warp::None, Warp::Psm, Warp::Lispsm, Warp::Tsm}) {
    const FittedMap fitted = seen.fit(directionalParameterization(), {kWarp(warp)}, 1024);
    const glm::dvec3 middle(0.2, 0.0, 46.0);
    const double size = 0.6;
    std::set<std::pair<int, int>> met;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const glm::dvec3 p = middle + size * glm::dvec3((i + 0.5) / kSteps - 0.5, 0.0, (j + 0.5) / kSteps - 0.5);
        const auto point = glsl::mapProject(fitted.map, glsl::lightFromWorld(fitted.frame, glm::vec3(p)));
        const glm::ivec2 texel = glsl::mapTexel(fitted.map, point.uv);
        met.insert({texel.x, texel.y});
      }
    }
    const auto density = texelDensity(fitted, middle, {0, 1, 0});
    ASSERT_TRUE(density.has_value());
    const double expected = *density * size * size;
    // Texels that the square's edge cuts count whole: the square and half a texel on each side, and half of that.
    const double side = std::sqrt(expected);
    EXPECT_GT(expected, 50.0) << kWarp.text(warp);
    EXPECT_GT(static_cast<double>(met.size()), expected) << kWarp.text(warp);
    EXPECT_LT(static_cast<double>(met.size()), (side + 2.0) * (side + 2.0) * 1.15) << kWarp.text(warp);
  }
}

TEST(TexelDensity, IsNothingOutsideTheMapAndZeroWhereTheLightGrazes) {
  const SeenScene seen = test::see(test::longFloor(), test::alongTheFloor(), test::sun(50.0, 60.0), 32);
  const FittedMap fitted = seen.fit(directionalParameterization(), {}, 256);
  EXPECT_FALSE(texelDensity(fitted, {0.0, 0.0, 5000.0}, {0, 1, 0}).has_value());
  const glm::dvec3 across = glm::normalize(glm::cross(seen.light.directionW, glm::dvec3(1, 0, 0)));
  const auto grazing = texelDensity(fitted, seen.scored.front(), across);
  ASSERT_TRUE(grazing.has_value());
  EXPECT_LT(*grazing, 1e-2);
}

TEST(TexelDensity, MedianIsOfThePixelsThatHaveOne) {
  EXPECT_EQ(medianDensity(std::vector<float>{-1.0f, 3.0f, 1.0f, 2.0f, -1.0f}), 2.0);
  EXPECT_EQ(medianDensity(std::vector<float>{-1.0f}), 0.0);
}

}  // namespace
}  // namespace gnomon
