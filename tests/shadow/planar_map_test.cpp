// shared/map.glsl for spot and directional maps: the functions are each other's inverses, and the same on
// both processors.
#include "map_fixture.h"
#include "map_functions.glsl"
#include "tests/run_kernel.h"

namespace gnomon {
namespace {

using namespace glsl;
using test::fittedDirectional;
using test::fittedSpot;
using test::MapSample;
using test::samplesOf;

class PlanarMap : public ::testing::TestWithParam<bool> {
 protected:
  FittedMap fitted_ = GetParam() ? fittedSpot() : fittedDirectional();
};

TEST_P(PlanarMap, APointOnATexelRayProjectsBackToItsUv) {
  for (const MapSample& sample : samplesOf(fitted_, 1 << 16, 1)) {
    const MapPoint point = mapProject(fitted_.map, sample.posL);
    ASSERT_TRUE(point.covered);
    // A two-thousandth of a texel of a map of 2048.
    ASSERT_NEAR(point.uv.x, sample.uv.x, 2.5e-7f * 4.0f);
    ASSERT_NEAR(point.uv.y, sample.uv.y, 2.5e-7f * 4.0f);
  }
}

TEST_P(PlanarMap, DepthGrowsStrictlyFromZeroToOneAlongEveryRay) {
  for (const MapSample& sample : samplesOf(fitted_, 1024, 2)) {
    const Ray ray = mapTexelRay(fitted_.map, 0, sample.uv);
    const float length = mapDistance(fitted_.map, 0, ray, 1.0f);
    EXPECT_NEAR(mapDepth(fitted_.map, 0, ray.origin), 0.0f, 1e-5f);
    EXPECT_NEAR(mapDepth(fitted_.map, 0, ray.origin + ray.dir * length), 1.0f, 1e-6f);
    float before = -1.0f;
    for (int i = 0; i <= 100; ++i) {
      const float depth =
          mapDepth(fitted_.map, 0, ray.origin + ray.dir * (length * static_cast<float>(i) / 100.0f));
      ASSERT_GT(depth, before);
      before = depth;
    }
  }
}

TEST_P(PlanarMap, DistanceInvertsDepth) {
  for (const MapSample& sample : samplesOf(fitted_, 1 << 16, 3)) {
    const Ray ray = mapTexelRay(fitted_.map, 0, sample.uv);
    const float along = glm::dot(sample.posL - ray.origin, ray.dir);
    const float slope = mapDepthSlope(fitted_.map, 0, sample.posL, ray.dir);
    // One rounding of depth, 2^-24, is 2^-24 / slope metres; eight of them bound the sums in between.
    ASSERT_NEAR(mapDistance(fitted_.map, 0, ray, sample.depth), along, 8.0f * 5.97e-8f / slope + 1e-5f);
  }
}

TEST_P(PlanarMap, DepthSlopeIsTheDerivativeAlongTheRay) {
  for (const MapSample& sample : samplesOf(fitted_, 4096, 4)) {
    const Ray ray = mapTexelRay(fitted_.map, 0, sample.uv);
    // In double, since a difference of floats would say nothing.
    const glm::dmat4 clip(fitted_.map.mapLayers[0].clipFromLight);
    const auto depth = [&](double t) {
      const glm::dvec4 p = clip * glm::dvec4(glm::dvec3(sample.posL) + glm::dvec3(ray.dir) * t, 1.0);
      return p.z / p.w;
    };
    const double h = 1e-4;
    const double expected = (depth(h) - depth(-h)) / (2.0 * h);
    ASSERT_NEAR(mapDepthSlope(fitted_.map, 0, sample.posL, ray.dir) / expected, 1.0, 1e-4);
  }
}

TEST_P(PlanarMap, WhatLiesOutsideTheWindowIsNotCovered) {
  for (const MapSample& sample : samplesOf(fitted_, 256, 5)) {
    const Ray edge = mapTexelRay(fitted_.map, 0, vec2(1.01f, sample.uv.y));
    EXPECT_FALSE(mapProject(fitted_.map, edge.origin + edge.dir).covered);
  }
  if (GetParam()) {  // behind the light
    EXPECT_FALSE(mapProject(fitted_.map, vec3(0, 0, 1)).covered);
  }
}

// Equation 10 of Dou et al. 2014, with the light's axis as the ray: eps / (sceneScale K) = f' there.
TEST(SpotMap, SlopeOnTheAxisIsEquation10OfDou) {
  const FittedMap fitted = fittedSpot();
  const double n = fitted.zNear, f = fitted.zFar;
  for (const double x : {1.01 * n, 0.5 * (n + f), 0.99 * f}) {
    const vec3 posL(0.0f, 0.0f, static_cast<float>(-x));
    const double depth = mapDepth(fitted.map, 0, posL);
    const double equation10 = std::pow(f - depth * (f - n), 2.0) / (f * n * (f - n));
    EXPECT_NEAR(mapDepthSlope(fitted.map, 0, posL, vec3(0, 0, -1)) / equation10, 1.0, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, PlanarMap, ::testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Spot" : "Directional"; });

class PlanarMapOnTheGpu : public gpu::GpuTest {};

TEST_F(PlanarMapOnTheGpu, EveryFunctionEqualsTheCpuBitForBit) {
  for (const FittedMap& fitted : {fittedSpot(), fittedDirectional()}) {
    std::vector<MapQuery> queries;
    for (const MapSample& sample : samplesOf(fitted, gpu::kKernelInputCount, 6))
      queries.push_back({sample.posL, sample.uv, sample.depth});
    const gpu::Buffer map = gpu::createBufferWith(
        device(), "map", std::vector<MapUniforms>{{.lightFrame = fitted.frame, .shadowMap = fitted.map}},
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const auto answers = gpu::runKernel<MapQuery, MapAnswer>(
        device(), GNOMON_TEST_SHADER("evaluate_map.comp.glsl"), queries, {{kBindMap, map}});
    int64_t worst = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
      const MapAnswer expected = answerMap(fitted.map, queries[i]);
      ASSERT_EQ(answers[i].layer, expected.layer);
      ASSERT_EQ(answers[i].covered, expected.covered);
      const auto compare = [&](float a, float b) { worst = std::max(worst, gpu::ulpDistance(a, b)); };
      for (int c = 0; c < 2; ++c) compare(answers[i].uv[c], expected.uv[c]);
      for (int c = 0; c < 3; ++c) compare(answers[i].origin[c], expected.origin[c]);
      for (int c = 0; c < 3; ++c) compare(answers[i].dir[c], expected.dir[c]);
      compare(answers[i].depth, expected.depth);
      compare(answers[i].slope, expected.slope);
      compare(answers[i].distance, expected.distance);
    }
    EXPECT_LE(worst,
              exactTolerance() == 0 ? 0 : 1 << 12);  // a GPU's fused products move differences of large terms
  }
}

}  // namespace
}  // namespace gnomon
