// shared/epipolar.glsl, epipolar_map.glsl, epipolar_bound.glsl and volume_lookup.glsl: round trips, the seam,
// the occupancy rule, bounds against brute force, and the same answers on both processors.
#include "round_trip.glsl"
#include "tests/run_kernel.h"
#include "vsv_fixture.h"

#include "shared/epipolar_bound.glsl"

#include <array>
#include <cmath>

namespace gnomon {
namespace {

using namespace glsl;

const VolumeSize kSize{.alpha = 256, .theta = 200, .phi = 128};

// Light on screen and off it, behind the eye, and the whole sphere; the axis is z in all.
std::vector<ShadowMap> maps() {
  const Camera towards = lookAt("towards the light", {0, 0, 0}, {0.1f, 0.05f, -1}, 1.0f);
  const Camera aside = lookAt("aside", {0, 0, 0}, {1, 0.2f, -0.1f}, 1.0f);
  const Camera away = lookAt("away from the light", {0, 0, 0}, {0.02f, -0.1f, 1}, 1.0f);
  return {test::columnsFor(3.0, kSize, VolumeFit::Full, aside).map,
          test::columnsFor(3.0, kSize, VolumeFit::Frustum, towards).map,
          test::columnsFor(0.2, kSize, VolumeFit::Frustum, aside).map,
          test::columnsFor(10.0, kSize, VolumeFit::Frustum, away).map};
}

vec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return unitVector(vec3(normal(random), normal(random), normal(random)));
}

std::vector<EpipolarQuery> queriesFor(const ShadowMap& map, size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<EpipolarQuery> queries(count);
  for (EpipolarQuery& query : queries) {
    const Ray ray = mapTexelRay(map, 0, vec2(unit(random), unit(random)));
    query.posL = ray.dir * (0.1f + 30.0f * unit(random));
    query.normalL = randomDirection(random);
    if (dot(query.normalL, query.posL) > 0.0f) query.normalL = -query.normalL;
  }
  return queries;
}

// Radians that an atan2 of rounded arguments and the ray's sines may turn, and metres they move along a ray.
constexpr float kTurned = 1.5e-6f;
float movedAlong(const ShadowMap& map, const EpipolarAnswer& answer, float r) {
  return kTurned / (answer.slope * alphaUpper(map.epipolar)) + 1e-6f * r;
}

TEST(EpipolarMap, APointComesBackToItsColumnAndItsDepthToItsDistance) {
  for (const ShadowMap& map : maps()) {
    const EpipolarGrid& grid = map.epipolar;
    size_t exact = 0, far = 0;
    for (const EpipolarQuery& query : queriesFor(map, size_t{1} << 18)) {
      const EpipolarAnswer answer = epipolarAnswer(map, query);
      const float r = length(query.posL), aside = length(vec2(query.posL));
      ASSERT_EQ(answer.covered, 1);
      const float slack = movedAlong(map, answer, r);
      if (slack > 0.1f * r) {  // far from light and eye alpha says next to nothing of the distance
        ++far;
        continue;
      }
      ASSERT_NEAR(answer.distance, r, slack);
      ASSERT_LT(length(answer.dir * r - query.posL), kTurned * r);
      const float columns = float(grid.thetaCount), rows = float(grid.phiCount);
      float off = std::abs(answer.uvAgain.x - answer.uv.x);
      if (thetaGoesRound(grid)) off = std::min(off, 1.0f - off);
      ASSERT_LE(off * columns * grid.thetaStep, kTurned * r / std::max(aside, 1e-6f));
      ASSERT_NEAR(answer.uvAgain.y * rows * grid.phiStep, answer.uv.y * rows * grid.phiStep, kTurned);
      ++exact;
    }
    EXPECT_GT(exact, 8 * far);
  }
}

// What columns are drawn with (vsv/draw_in_epipolar.frag.glsl).
TEST(EpipolarMap, DrawnRaysAndDepthsHaveTheBitsOfTheMaps) {
  for (const ShadowMap& map : maps()) {
    const vec4 theta = mapDrawnNumbers(map);
    const vec4 phi = mapMoreDrawnNumbers(map);
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        const vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const Ray ray = mapTexelRay(map, 0, center / mapTexelCounts(map));
        ASSERT_EQ(epipolarMapDrawnRay(theta, phi, center), ray.dir);
        const vec3 posL = ray.dir * (0.1f + 0.01f * static_cast<float>(x));
        ASSERT_EQ(epipolarMapDrawnDepth(theta, phi, posL), mapDepth(map, 0, posL));
      }
    }
  }
}

TEST(EpipolarMap, TheSlopeIsTheDerivativeOfDepth) {
  for (const ShadowMap& map : maps()) {
    const double D = map.epipolar.eyeDistance;
    for (const EpipolarQuery& query : queriesFor(map, 4096)) {
      const EpipolarAnswer answer = epipolarAnswer(map, query);
      const dvec3 dir = normalize(dvec3(query.posL));
      const auto alpha = [&](double r) { return std::atan2(r * std::hypot(dir.x, dir.y), D - r * dir.z); };
      const double r = length(dvec3(query.posL)), h = 1e-5 * r;
      const double expected = (alpha(r + h) - alpha(r - h)) / (2.0 * h) / alphaUpper(map.epipolar);
      // phi is small near the axis, and so rounded there.
      const double relative = 2e-5 + 4.0 * kTurned / std::max(std::hypot(dir.x, dir.y), 1e-6);
      ASSERT_NEAR(answer.slope / expected, 1.0, relative);
    }
  }
}

TEST(EpipolarMap, ThetaWrapsAcrossItsSeamAndPhiAcrossItsPole) {
  const ShadowMap map = maps().front();
  ASSERT_TRUE(thetaGoesRound(map.epipolar));
  for (int j = 0; j < map.height; ++j) {
    for (const auto& [beyond, expected] :
         {std::pair(ivec2(-1, j), ivec2(map.width - 1, j)), std::pair(ivec2(map.width, j), ivec2(0, j)),
          std::pair(ivec2(map.width + 2, j), ivec2(2, j))}) {
      const vec3 posL = mapTexelRay(map, 0, mapTexelCenter(map, beyond)).dir * 2.0f;
      const MapTexel found = mapTexelAcross(map, 0, beyond, posL);
      ASSERT_TRUE(found.held);
      ASSERT_EQ(found.texel, expected);
    }
  }
  for (int i = 0; i < map.width; ++i) {
    const MapTexel found = mapTexelAcross(map, 0, {i, -1}, vec3(0, 0, 1));
    EXPECT_EQ(found.texel, ivec2((i + map.width / 2) % map.width, 0));
  }
  // Points a hair to either side of the seam, and on it.
  for (const float x : {-1e-7f, -1e-30f, 0.0f, 1e-30f, 1e-7f})
    EXPECT_TRUE(mapProject(map, vec3(x, -1.0f, 0.3f)).covered);
  // A volume that does not go round ends at its sides.
  const ShadowMap part = maps()[2];
  ASSERT_FALSE(thetaGoesRound(part.epipolar));
  const float beside = part.epipolar.thetaLower - 0.1f;
  EXPECT_FALSE(mapProject(part, epipolarDirection(beside, 1.0f)).covered);
  EXPECT_FALSE(mapTexelAcross(part, 0, {-1, 5}, epipolarDirection(beside, 1.0f)).held);
}

TEST(EpipolarMap, TheFirstOccludedVoxelObeysTheRule) {
  std::mt19937 random(2);
  for (const ShadowMap& map : maps()) {
    const EpipolarGrid& grid = map.epipolar;
    std::uniform_real_distribution<float> alphas(-0.1f, 3.3f);
    for (int n = 0; n < 1 << 16; ++n) {
      // Every fourth on a centre, where the rule is strict.
      const float alpha = n % 4 == 0 ? alphaCenter(grid, n / 4 % grid.alphaCount) : alphas(random);
      const int first = firstOccluded(grid, alpha);
      ASSERT_TRUE(first == 0 || !(alphaCenter(grid, first - 1) > alpha));
      ASSERT_TRUE(first == grid.alphaCount || alphaCenter(grid, first) > alpha);
    }
    EXPECT_EQ(firstOccluded(grid, INFINITY), grid.alphaCount);
  }
}

// Word for word: the voxel that holds F', or where F' is before its centre the neighbour nearer the light.
TEST(EpipolarMap, TheChosenVoxelIsThatOfAlgorithmTwo) {
  std::mt19937 random(2);
  for (const ShadowMap& map : maps()) {
    const EpipolarGrid& grid = map.epipolar;
    std::uniform_real_distribution<float> alphas(grid.alphaLower, alphaUpper(grid));
    for (int n = 0; n < 1 << 16; ++n) {
      const float alpha = n % 4 == 0 ? alphaCenter(grid, n / 4 % grid.alphaCount) : alphas(random);
      const int holds = voxelHolding(grid, alpha);
      ASSERT_EQ(voxelNotBehind(grid, alpha), alpha >= alphaCenter(grid, holds) ? holds : holds - 1) << alpha;
    }
  }
}

// By the box, or over the seam of theta by its part a turn lower (shaders/vsv/bound_in_epipolar.comp.glsl).
bool isDrawn(const EpipolarGrid& grid, const EpipolarBox& box, dvec2 at) {
  const auto within = [&](double turn) {
    return at.x + turn >= box.low.x && at.x + turn <= box.high.x && at.y >= box.low.y && at.y <= box.high.y;
  };
  return within(0.0) || (epipolarBoxOverSeam(grid, box) && within(2.0 * kPi / grid.thetaStep));
}

// Large and small ones, slivers along a meridian, about either pole, across the seam, and with the light
// almost in their plane.
LightTriangle awkwardTriangle(std::mt19937& random, int n) {
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  const auto near_ = [&](vec3 center, float size) {
    return center + vec3(unit(random), unit(random), unit(random)) * size;
  };
  const float size = std::pow(10.0f, 2.0f * unit(random) - 0.5f);
  vec3 center = randomDirection(random) * 3.0f;
  switch (n % 6) {
    case 0:
      return lightTriangle(near_(center, size), near_(center, size), near_(center, size));
    case 1:
      center = vec3(0, 0, n % 12 < 6 ? 3.0f : -3.0f) + vec3(unit(random), unit(random), 0) * (0.3f * size);
      return lightTriangle(near_(center, size), near_(center, size), near_(center, size));
    case 2: {  // in a plane with the axis, to rounding
      const vec3 out = epipolarDirection(3.14f * unit(random), 1.57f);
      const auto inPlane = [&] { return out * (2.0f + unit(random)) + vec3(0, 0, 3.0f * unit(random)); };
      return lightTriangle(inPlane(), inPlane(), inPlane());
    }
    case 3:
      center = vec3(0.0f, -3.0f, 3.0f * unit(random));
      return lightTriangle(near_(center, size), near_(center, size), near_(center, size));
    case 4: {  // a floor close under the light
      const float height = 0.02f * std::abs(unit(random)) + 1e-3f;
      const auto onFloor = [&] { return vec3(5.0f * unit(random), -height, 5.0f * unit(random)); };
      return lightTriangle(onFloor(), onFloor(), onFloor());
    }
  }
  return lightTriangle(vec3(0, 0, 2.0f), near_(center, size), near_(center, size));
}

// What a bias's row says of volumes is what the look-up knows.
TEST(VolumeLookup, KnowsTheBiasesThatSaySo) {
  const ShadowMap map = maps().front();
  const Receiver receiver{{0.1f, 0.2f, -1.0f}, {0.0f, 0.0f, 1.0f}};
  size_t knownCount = 0;
  for (const BiasMethod& method : biasMethods()) {
    bool known = !method.onVolumes;
    decidingVoxel(method.id, map, defaultBiasParams(method, map.sceneScale), receiver,
                  mapTexelRay(map, 0, vec2(0.5f, 0.5f)), known);
    EXPECT_EQ(known, method.onVolumes) << method.name;
    knownCount += known ? 1 : 0;
  }
  EXPECT_EQ(knownCount, 3u);
}

TEST(EpipolarBound, EveryColumnWhoseRayMeetsTheTriangleIsDrawn) {
  std::mt19937 random(5);
  for (const ShadowMap& map : maps()) {
    const EpipolarGrid& grid = map.epipolar;
    size_t met = 0, allRound = 0, wrapped = 0;
    std::vector<vec3> rays;
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) rays.push_back(mapTexelRay(map, 0, mapTexelCenter(map, {x, y})).dir);
    for (int n = 0; n < 600; ++n) {
      const LightTriangle triangle = awkwardTriangle(random, n);
      const EpipolarBox box = epipolarBox(grid, triangle);
      allRound += box.allRound ? 1 : 0;
      wrapped += epipolarBoxOverSeam(grid, box) ? 1 : 0;
      for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
          const vec3& dir = rays[static_cast<size_t>(y * map.width + x)];
          if (!isWithin(sideDistances(triangle, dir))) continue;
          ++met;
          ASSERT_TRUE(isDrawn(grid, box, dvec2(x + 0.5, y + 0.5))) << n << ": " << x << ", " << y;
        }
      }
    }
    EXPECT_GT(met, 10000u);
    EXPECT_GT(allRound, 50u);
    EXPECT_LT(allRound, 250u);  // slivers along a meridian are not
    EXPECT_GT(wrapped, 20u);
  }
}

class EpipolarMapOnTheGpu : public gpu::GpuTest {};

// sin, cos: 1 ulp, atan2: 3.3e-6 (STYLE of the shared GLSL: docs/shared_glsl.md): an angle differs by at most
// 4e-6 and as much again of what turned with it.
TEST_F(EpipolarMapOnTheGpu, PointsColumnsAndVoxelsAreThoseOfTheCpu) {
  constexpr float kAngle = 8e-6f;
  for (const ShadowMap& map : maps()) {
    const EpipolarGrid& grid = map.epipolar;
    const std::vector<EpipolarQuery> queries = queriesFor(map, size_t{1} << 17);
    const gpu::Buffer uniforms = gpu::createBufferWith(device(), "map", std::vector<MapUniforms>{{.shadowMap = map}},
                                                       VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const auto answers = gpu::runKernel<EpipolarQuery, EpipolarAnswer>(
        device(), GNOMON_TEST_SHADER("evaluate_round_trip.comp.glsl"), queries, {{kBindMap, uniforms}});
    size_t otherColumn = 0, otherVoxel = 0;
    for (size_t n = 0; n < queries.size(); ++n) {
      const EpipolarAnswer cpu = epipolarAnswer(map, queries[n]);
      const EpipolarAnswer& gpu = answers[n];
      ASSERT_EQ(gpu.covered, cpu.covered);
      ASSERT_NEAR(gpu.depth * alphaUpper(grid), cpu.depth * alphaUpper(grid), kAngle);
      ASSERT_NEAR(gpu.uv.y * float(grid.phiCount) * grid.phiStep, cpu.uv.y * float(grid.phiCount) * grid.phiStep,
                  kAngle);
      ASSERT_NEAR(gpu.uv.x * float(grid.thetaCount) * grid.thetaStep,
                  cpu.uv.x * float(grid.thetaCount) * grid.thetaStep, kAngle);
      if (mapTexel(map, gpu.uv) != mapTexel(map, cpu.uv)) {
        ++otherColumn;
        continue;
      }
      ASSERT_LE(std::abs(gpu.voxelNone - cpu.voxelNone), 1);
      otherVoxel += gpu.voxelNone != cpu.voxelNone || gpu.voxelConstant != cpu.voxelConstant ||
                            gpu.voxelAdaptive != cpu.voxelAdaptive
                        ? 1
                        : 0;
    }
    // A boundary within the tolerance: twice kAngle of each step, for two angles and three methods.
    const double most = 2.0 * kAngle * static_cast<double>(queries.size());
    EXPECT_LE(otherColumn, most * (1.0 / grid.thetaStep + 1.0 / grid.phiStep));
    EXPECT_LE(otherVoxel, most * 3.0 / grid.alphaStep + 2.0);
  }
}

}  // namespace
}  // namespace gnomon
