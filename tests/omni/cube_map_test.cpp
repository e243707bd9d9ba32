// shared/cube_map.glsl: round trips, edges, the rasterizer's bits, and the same answers on both processors.
#include "omni_fixture.h"
#include "omni_functions.glsl"
#include "tests/run_kernel.h"

namespace gnomon {
namespace {

using namespace glsl;

FittedMap cube(CubeDepth depth, int side = 256) {
  return makeCubeMap({0.0, 0.0, 0.0}, depth, 0.05, 20.0, side, 30.0f);
}
const CubeDepth kBoth[] = {CubeDepth::Hyperbolic, CubeDepth::Radial};

std::vector<RoundTripQuery> queriesAllAround(const FittedMap& fitted, size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<RoundTripQuery> queries(count);
  for (RoundTripQuery& query : queries) {
    query.posL = test::randomDirection(random) * (0.1f + 19.0f * unit(random));
    query.depth = mapDepth(fitted.map, cubeFace(query.posL), query.posL);
  }
  return queries;
}

TEST(CubeMap, TheFacesAreThoseOfVulkan) {
  const FittedMap fitted = cube(CubeDepth::Hyperbolic);
  // The table of the specification, at one point of each face: s/m = 0.5, t/m = -0.25.
  const vec3 points[6] = {vec3(2, 0.5f, -1), vec3(-2, 0.5f, 1),   vec3(1, 2, -0.5f),
                          vec3(1, -2, 0.5f), vec3(1, 0.5f, 2.0f), vec3(-1, 0.5f, -2.0f)};
  for (int face = 0; face < 6; ++face) {
    const MapPoint point = mapProject(fitted.map, points[face]);
    EXPECT_EQ(point.slice, face);
    EXPECT_EQ(point.uv, vec2(0.75f, 0.375f)) << face;
  }
  EXPECT_FALSE(mapProject(fitted.map, vec3(0.0f)).covered);
}

// To the bit: no point lands elsewhere than its caster is drawn.
TEST(CubeMap, TheChosenFaceIsWhatTheLayersMatrixGives) {
  const FittedMap fitted = cube(CubeDepth::Hyperbolic);
  std::mt19937 random(3);
  for (int i = 0; i < 1 << 16; ++i) {
    const vec3 posL = test::randomDirection(random) * 5.0f;
    const MapPoint point = mapProject(fitted.map, posL);
    const vec4 clip = transform(fitted.map.mapSlices[point.slice].clipFromLight, vec4(posL, 1.0f));
    ASSERT_EQ(point.uv.x, clip.x / clip.w * 0.5f + 0.5f);
    ASSERT_EQ(point.uv.y, clip.y / clip.w * 0.5f + 0.5f);
    ASSERT_EQ(mapDepth(fitted.map, point.slice, posL), clip.z / clip.w);
    ASSERT_TRUE(point.uv.x >= 0.0f && point.uv.x <= 1.0f && point.uv.y >= 0.0f && point.uv.y <= 1.0f);
  }
}

TEST(CubeMap, APointComesBackToItsUvAndItsDepthToItsDistance) {
  for (const CubeDepth depth : kBoth) {
    const FittedMap fitted = cube(depth);
    size_t acrossAnEdge = 0;
    for (const RoundTripQuery& query : queriesAllAround(fitted, size_t{1} << 20)) {
      const RoundTrip answer = roundTrip(fitted.map, query);
      if (answer.sliceAgain == answer.slice) {
        // uv is 0.5 + half a ratio: two roundings of 2^-24 there and back.
        ASSERT_NEAR(answer.uvAgain.x, answer.uv.x, 2.5e-7f);
        ASSERT_NEAR(answer.uvAgain.y, answer.uv.y, 2.5e-7f);
      } else {
        ++acrossAnEdge;
        const float edge = std::max(std::abs(answer.uv.x - 0.5f), std::abs(answer.uv.y - 0.5f));
        ASSERT_NEAR(edge, 0.5f, 2.5e-7f);
      }
      // One rounding of depth is 2^-24 / slope metres; eight bound the sums in between.
      const float along = length(query.posL - answer.origin);
      ASSERT_NEAR(answer.distance, along, 8.0f * 5.97e-8f / answer.slope + 1e-5f);
    }
    EXPECT_LT(acrossAnEdge, 32u);
  }
}

TEST(CubeMap, DepthGrowsFromZeroToOneAndItsSlopeIsItsDerivative) {
  std::mt19937 random(5);
  for (const CubeDepth depth : kBoth) {
    const FittedMap fitted = cube(depth);
    for (int i = 0; i < 1000; ++i) {
      const vec3 dir = test::randomDirection(random);
      const int slice = cubeFace(dir);
      const Ray ray = mapTexelRay(fitted.map, slice, mapProject(fitted.map, dir).uv);
      const float length_ = mapDistance(fitted.map, slice, ray, 1.0f);
      EXPECT_NEAR(mapDepth(fitted.map, slice, ray.origin), 0.0f, 2e-5f);
      EXPECT_NEAR(mapDepth(fitted.map, slice, ray.origin + ray.dir * length_), 1.0f, 1e-6f);
      float before = -1.0f;
      for (int k = 0; k <= 100; ++k) {
        const float t = length_ * static_cast<float>(k) / 100.0f;
        const vec3 posL = ray.origin + ray.dir * t;
        const float here = mapDepth(fitted.map, slice, posL);
        ASSERT_GT(here, before);
        before = here;
        // Analytic in double: 1 / (f - n), or f n / (f - n) / m^2 times the cosine to the axis.
        const double n = fitted.map.zNear, f = fitted.map.zFar;
        const vec3 stm = cubeFaceFromLight(slice, posL);
        const double expected = depth == CubeDepth::Radial
                                    ? 1.0 / (f - n)
                                    : f * n / (f - n) / (double(stm.z) * stm.z) * cubeFaceFromLight(slice, ray.dir).z;
        ASSERT_NEAR(mapDepthSlope(fitted.map, slice, posL, ray.dir) / expected, 1.0, 1e-5);
      }
    }
  }
}

// A texel one beyond an edge stands for the direction in which its ray looks; what answers for it is the
// texel of the next face whose ray is nearest to that.
TEST(CubeMap, ATapBeyondAnyEdgeLandsOnTheTexelWhoseRayIsNearest) {
  constexpr int kSide = 16;
  const FittedMap fitted = cube(CubeDepth::Radial, kSide);
  for (int slice = 0; slice < 6; ++slice) {
    for (int i = 0; i < kSide; ++i) {
      for (const ivec2 beyond : {ivec2(-1, i), ivec2(kSide, i), ivec2(i, -1), ivec2(i, kSide)}) {
        const vec3 wanted = mapTexelRay(fitted.map, slice, mapTexelCenter(fitted.map, beyond)).dir;
        const MapTexel found = mapTexelAcross(fitted.map, slice, beyond, wanted * 3.0f);
        ASSERT_TRUE(found.held);
        ASSERT_NE(found.slice, slice);
        float best = -1.0f;
        for (int other = 0; other < 6; ++other)
          for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
              best =
                  std::max(best, dot(wanted, mapTexelRay(fitted.map, other, mapTexelCenter(fitted.map, {x, y})).dir));
        const vec3 got = mapTexelRay(fitted.map, found.slice, mapTexelCenter(fitted.map, found.texel)).dir;
        // Nearest up to ties: a direction near the border of two texels may fall to either by the square's shape.
        ASSERT_LT(std::acos(std::min(1.0f, dot(wanted, got))), std::acos(std::min(1.0f, best)) * 1.2f + 1e-3f);
      }
    }
  }
}

class CubeMapOnTheGpu : public gpu::GpuTest {};

TEST_F(CubeMapOnTheGpu, AMillionRoundTripsEqualTheCpuBitForBit) {
  for (const CubeDepth depth : kBoth) {
    const FittedMap fitted = cube(depth);
    const std::vector<RoundTripQuery> queries = queriesAllAround(fitted, size_t{1} << 20);
    const gpu::Buffer map = gpu::createBufferWith(
        device(), "map", std::vector<MapUniforms>{{.lightFrame = fitted.frame, .shadowMap = fitted.map}},
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const auto answers = gpu::runKernel<RoundTripQuery, RoundTrip>(
        device(), GNOMON_TEST_SHADER("evaluate_round_trip.comp.glsl"), queries, {{kBindMap, map}});
    const test::RoundTripDifference difference =
        test::compareRoundTrips(answers, queries, fitted.map, [&](float a, float b) { return apart(a, b); });
    EXPECT_LE(difference.worst, apartAtMost());
    EXPECT_LE(difference.elsewhere, isLavapipe() ? 0 : queries.size() / 100000);  // on a face's or a hemisphere's rim
  }
}

}  // namespace
}  // namespace gnomon
