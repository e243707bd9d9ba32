// shared/map.glsl for spot and directional maps: the functions are each other's inverses, and the same on
// both processors.
#include "map_fixture.h"
#include "map_functions.glsl"
#include "seen_scene.h"
#include "tests/run_kernel.h"

#include <algorithm>
#include <ostream>

#include <glm/gtx/component_wise.hpp>

namespace gnomon {
namespace {

using namespace glsl;
using test::fittedDirectional;
using test::fittedSpot;
using test::MapSample;
using test::samplesOf;

struct Kind {
  const char* name;
  bool spot;
  Warp warp;
};
// ctest shows it beside the test's name.
void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}
constexpr Kind kKinds[] = {{"Spot", true, Warp::None},
                           {"SpotPsm", true, Warp::Psm},
                           {"SpotLispsm", true, Warp::Lispsm},
                           {"SpotTsm", true, Warp::Tsm},
                           {"Directional", false, Warp::None},
                           {"DirectionalPsm", false, Warp::Psm},
                           {"DirectionalLispsm", false, Warp::Lispsm},
                           {"DirectionalTsm", false, Warp::Tsm}};

FittedMap fittedKind(const Kind& kind) {
  if (kind.warp == Warp::None) return kind.spot ? fittedSpot() : fittedDirectional();
  const Parameterization& map = kind.spot ? spotParameterization() : directionalParameterization();
  return test::see("contact", map, 64, 1).fit(map, {kWarp(kind.warp)});
}

// The greatest and the least W of the slice: 1 without a warp.
double warpRatio(const FittedMap& fitted) {
  double least = 1e30, most = 0.0;
  for (const vec2& uv : {vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(1, 1)}) {
    const vec3 near = mapTexelRay(fitted.map, 0, uv).origin;
    const double axis = fitted.map.mapSlices[0].clipFromLight[3][3] == 0.0f ? -static_cast<double>(near.z) : 1.0;
    const double w = static_cast<double>(transform(fitted.map.mapSlices[0].clipFromLight, vec4(near, 1.0f)).w) / axis;
    least = std::min(least, w);
    most = std::max(most, w);
  }
  return most / least;
}

class PlanarMap : public ::testing::TestWithParam<Kind> {
 protected:
  FittedMap fitted_ = fittedKind(GetParam());
};

TEST_P(PlanarMap, IsWarpedWhereItSaysSo) {
  if (GetParam().warp == Warp::None)
    EXPECT_NEAR(warpRatio(fitted_), 1.0, 1e-3);
  else
    EXPECT_GT(warpRatio(fitted_), 1.3);
}

// The uv of a point is a quotient of sums of four products. With M the largest of |row . |p|| over X, Y and
// W, each sum rounds by some 4 ulps of M, the point itself was rounded twice on its way (ray and sum), and
// the quotient halves: 16 * 2^-24 M / w.
float uvTolerance(const FittedMap& fitted, const vec3& posL) {
  const mat4& m = fitted.map.mapSlices[0].clipFromLight;
  float terms = 0.0f;
  for (const int row : {0, 1, 3}) {
    const vec4 magnitudes(std::abs(m[0][row]), std::abs(m[1][row]), std::abs(m[2][row]), std::abs(m[3][row]));
    terms = std::max(terms, dot(magnitudes, vec4(abs(posL), 1.0f)));
  }
  return 16.0f * 5.97e-8f * terms / transform(m, vec4(posL, 1.0f)).w;
}

TEST_P(PlanarMap, APointOnATexelRayProjectsBackToItsUv) {
  double worst = 0.0;
  for (const MapSample& sample : samplesOf(fitted_, 1 << 16, 1)) {
    const MapPoint point = mapProject(fitted_.map, sample.posL);
    const float tolerance = uvTolerance(fitted_, sample.posL);
    ASSERT_TRUE(point.covered ||
                std::min({sample.uv.x, sample.uv.y, 1.0f - sample.uv.x, 1.0f - sample.uv.y}) < tolerance);
    ASSERT_NEAR(point.uv.x, sample.uv.x, tolerance);
    ASSERT_NEAR(point.uv.y, sample.uv.y, tolerance);
    worst = std::max(worst, static_cast<double>(glm::compMax(abs(point.uv - sample.uv))));
  }
  EXPECT_LT(worst * 2048.0, 0.125);  // texels of a map of 2048: what kMostWarp promises
}

TEST_P(PlanarMap, DepthGrowsStrictlyFromZeroToOneAlongEveryRay) {
  for (const MapSample& sample : samplesOf(fitted_, 1024, 2)) {
    const Ray ray = mapTexelRay(fitted_.map, 0, sample.uv);
    const float length = mapDistance(fitted_.map, 0, ray, 1.0f);
    EXPECT_NEAR(mapDepth(fitted_.map, 0, ray.origin), 0.0f, 1e-5f);
    EXPECT_NEAR(mapDepth(fitted_.map, 0, ray.origin + ray.dir * length), 1.0f, 1e-6f);
    float before = -1.0f;
    for (int i = 0; i <= 100; ++i) {
      const float depth = mapDepth(fitted_.map, 0, ray.origin + ray.dir * (length * static_cast<float>(i) / 100.0f));
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
    const glm::dmat4 clip(fitted_.map.mapSlices[0].clipFromLight);
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
  if (GetParam().spot) {  // behind the light, on the very lines of its rays
    for (const MapSample& sample : samplesOf(fitted_, 256, 6))
      EXPECT_FALSE(mapProject(fitted_.map, -sample.posL).covered);
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

INSTANTIATE_TEST_SUITE_P(Kinds, PlanarMap, ::testing::ValuesIn(kKinds),
                         [](const auto& tested) { return std::string(tested.param.name); });

class PlanarMapOnTheGpu : public gpu::GpuTest {};

TEST_F(PlanarMapOnTheGpu, EveryFunctionEqualsTheCpuBitForBit) {
  for (const Kind& kind : kKinds) {
    const FittedMap fitted = fittedKind(kind);
    std::vector<MapQuery> queries;
    for (const MapSample& sample : samplesOf(fitted, gpu::kKernelInputCount, 6))
      queries.push_back({sample.posL, sample.uv, sample.depth});
    const gpu::Buffer map = gpu::createBufferWith(
        device(), "map", std::vector<MapUniforms>{{.lightFrame = fitted.frame, .shadowMap = fitted.map}},
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const auto answers = gpu::runKernel<MapQuery, MapAnswer>(device(), GNOMON_TEST_SHADER("evaluate_map.comp.glsl"),
                                                             queries, {{kBindMap, map}});
    int64_t worst = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
      const MapAnswer expected = answerMap(fitted.map, queries[i]);
      ASSERT_EQ(answers[i].slice, expected.slice);
      ASSERT_EQ(answers[i].covered, expected.covered);
      const auto compare = [&](float a, float b) { worst = std::max(worst, apart(a, b)); };
      for (int c = 0; c < 2; ++c) compare(answers[i].uv[c], expected.uv[c]);
      for (int c = 0; c < 3; ++c) compare(answers[i].origin[c], expected.origin[c]);
      for (int c = 0; c < 3; ++c) compare(answers[i].dir[c], expected.dir[c]);
      compare(answers[i].depth, expected.depth);
      compare(answers[i].slope, expected.slope);
      compare(answers[i].distance, expected.distance);
    }
    EXPECT_LE(worst, apartAtMost()) << kind.name;
  }
}

}  // namespace
}  // namespace gnomon
