// shared/bias.glsl gives the same verdicts on both processors, for every bias on every parameterization.
//
// A verdict is one bit, and a random depth is far from where it turns. So the depth is searched at which the CPU's
// verdict turns from shadow to light, to neighbouring floats, and the GPU is asked for both: an ulp anywhere in a bias,
// in a projection, a ray, a depth or a distance, is a wrong verdict.
#include "lab/core/maps.h"
#include "map_functions.glsl"
#include "omni/cube_map.h"
#include "plane_case.h"
#include "seen_scene.h"
#include "tests/run_kernel.h"
#include "vsv/volume_parameterization.h"

#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace gnomon {
namespace {

using namespace glsl;
using test::MapSample;
using test::PlaneCase;
using test::samplesOf;

struct MapCase {
  const char* label;
  const char* parameterization;
  MapOptions options = {};
};

// Every parameterization, and of each what changes its projection or its depth.
std::vector<MapCase> mapCases() {
  return {{"spot", "spot"},
          {"spot, PSM", "spot", {kWarp(Warp::Psm)}},
          {"spot, LiSPSM", "spot", {kWarp(Warp::Lispsm)}},
          {"spot, TSM", "spot", {kWarp(Warp::Tsm)}},
          {"directional", "directional"},
          {"directional, PSM", "directional", {kWarp(Warp::Psm)}},
          {"directional, LiSPSM", "directional", {kWarp(Warp::Lispsm)}},
          {"directional, TSM", "directional", {kWarp(Warp::Tsm)}},
          {"cascades", "directional", {kCascades(3)}},
          {"cube, hyperbolic", "cube", {kCubeDepth(CubeDepth::Hyperbolic)}},
          {"cube, radial", "cube", {kCubeDepth(CubeDepth::Radial)}},
          {"paraboloid", "paraboloid"},
          {"columns of a shadow volume", "vsv", {kVolumeSize({.alpha = 128, .theta = 128, .phi = 128})}}};
}

const Parameterization& parameterizationOf(const MapCase& c) {
  return *parseMaps(c.parameterization).front();
}

FittedMap fit(const MapCase& c) {
  const Parameterization& map = parameterizationOf(c);
  return test::see("contact", map, 64, 1).fit(map, c.options);
}

// Those that mean something on the map, the user's, and none.
std::vector<int> methodsOn(const Parameterization& map) {
  std::vector<int> methods = {kBiasUser, kNoSuchBias};
  for (const BiasMethod& method : biasMethods())
    if (map.supportsBias(method) && !method.knowsSurfaces()) methods.push_back(method.id);
  return methods;
}

// At a method's defaults; of the user's all 0.
BiasParams paramsOf(int id, float sceneScale) {
  for (const BiasMethod& method : biasMethods())
    if (method.id == id) return defaultBiasParams(method, sceneScale);
  return {};
}

// Depths on either side of where the CPU's verdict turns; absent where it does not between 0 and 1.
struct Turn {
  float shadow, light;  // neighbours
};
std::optional<Turn> findTurn(const ShadowMap& map, BiasQuery query) {
  const auto lights = [&](uint32_t bits) {
    query.z1 = query.zBack = std::bit_cast<float>(bits);
    return answerBias(map, query) == kAnswerLight;
  };
  // Floats of one sign are ordered as their bits are.
  uint32_t shadow = std::bit_cast<uint32_t>(0.0f), light = std::bit_cast<uint32_t>(1.0f) - 1;
  if (lights(shadow) || !lights(light)) return std::nullopt;
  while (light - shadow > 1) {
    const uint32_t middle = shadow + (light - shadow) / 2;
    (lights(middle) ? light : shadow) = middle;
  }
  return Turn{std::bit_cast<float>(shadow), std::bit_cast<float>(light)};
}

// How far from where the CPU's verdict turns the GPU's may turn, in depth.
//
// Where a bias subtracts sums that have a factor in common the driver's optimizer takes it out (docs/shared_glsl.md),
// and the difference rounds otherwise, by ulps of what is subtracted. receiver-plane, normal-offset and what engines do
// subtract what two rays say; eevee besides that twice the sum of two changes of its plane's depth, which makes five
// times as much. Where depth is linear in the radius r, (r - near) / (far - near), slope and the adaptive three
// subtract such depths. Measured on lavapipe: more than 16 * 2^-24, none beyond 32. Everything else is exact.
//
// A shadow volume's columns stand on sin, cos and atan2, which turn an angle by up to 8e-6 (epipolar_map_test.cpp).
float depthTolerance(const ShadowMap& map, int method, bool lavapipe) {
  if (map.kind == kMapEpipolar) return 8e-6f / alphaUpper(map.epipolar);
  if (!lavapipe) return 256.0f * 5.97e-8f;  // products fused with sums, anywhere
  const bool radial = map.kind == kMapCubeRadial || map.kind == kMapParaboloid;
  const bool byDifferences = method == kBiasReceiverPlane || method == kBiasNormalOffset || method == kBiasEevee ||
                             method == kBiasGodot || method == kBiasBevy || method == kBiasUnrealVsm;
  const bool subtractsDepths =
      method == kBiasSlope || method == kBiasAdaptive || method == kBiasAdaptiveClamped || method == kBiasAdaptiveEhm;
  const float ulps = byDifferences || (radial && subtractsDepths) ? 32.0f : 0.0f;
  return (method == kBiasEevee ? 5.0f : 1.0f) * ulps * 5.97e-8f;
}

struct Asked {
  std::vector<BiasQuery> queries;
  std::map<int, size_t> cases, turns;  // by method
};

// Of each receiver on its plane: either side of the turn, and two depths about the plane's.
Asked ask(const FittedMap& fitted, const std::vector<int>& methods, bool lavapipe) {
  std::mt19937 random(15);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  Asked asked;
  size_t i = 0;
  for (const MapSample& sample : samplesOf(fitted, gpu::kKernelInputCount / 4, 16)) {
    const float tanAngle = std::tan(unit(random) * 1.55f);  // to 88.8 degrees
    const PlaneCase c = test::planeCase(fitted.map, sample, tanAngle, unit(random) * 6.0f);
    BiasQuery query{.method = methods[i % methods.size()],
                    .params = paramsOf(methods[i % methods.size()], fitted.map.sceneScale),
                    .receiver = c.receiver,
                    .z1 = c.tap.z1,
                    .z2 = c.tap.z1 + unit(random) * 0.1f,
                    .zBack = 0.0f};
    query.params.epsilonAt = static_cast<int>(i / methods.size() % 3);
    ++asked.cases[query.method];
    std::vector<float> depths = {0.25f, 0.75f};
    const float tolerance = depthTolerance(fitted.map, query.method, lavapipe);
    const std::optional<Turn> turn = findTurn(fitted.map, query);
    if (turn) {
      depths = {turn->shadow - tolerance, turn->light + tolerance};
      ++asked.turns[query.method];
    }
    for (int n = 0; n < 2; ++n) {
      const float z1 = std::min(c.tap.z1 + (unit(random) - 0.5f) * 1e-3f, 0.9999f);
      const bool undecided = turn && z1 > depths[0] && z1 < depths[1];
      depths.push_back(undecided ? depths[0] : z1);
    }
    for (const float z1 : depths) {
      query.z1 = query.zBack = z1;
      asked.queries.push_back(query);
    }
    ++i;
  }
  return asked;
}

class BiasOnTheGpu : public gpu::GpuTest {};

TEST_F(BiasOnTheGpu, VerdictsEqualTheCpuForEveryMethodOnEveryMap) {
  std::set<std::string> names;
  for (const MapCase& c : mapCases()) {
    SCOPED_TRACE(c.label);
    names.insert(c.parameterization);
    const FittedMap fitted = fit(c);
    const std::vector<int> methods = methodsOn(parameterizationOf(c));
    const Asked asked = ask(fitted, methods, isLavapipe());
    ASSERT_GE(asked.queries.size(), gpu::kKernelInputCount);
    for (const auto& [method, cases] : asked.cases) {
      if (method == kNoSuchBias) continue;
      EXPECT_GT(asked.turns.at(method), cases * 9 / 10) << "method " << method;
    }
    const gpu::Buffer map = gpu::createBufferWith(
        device(), "map", std::vector<MapUniforms>{{.lightFrame = fitted.frame, .shadowMap = fitted.map}},
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const auto answers =
        gpu::runKernel<BiasQuery, uint>(device(), GNOMON_TEST_SHADER("evaluate_bias.comp.glsl"), asked.queries,
                                        {{kBindMap, map}}, {{.id = 2, .value = fitted.map.kind}});
    std::map<int, size_t> different, unknown;
    for (size_t i = 0; i < answers.size(); ++i) {
      const BiasQuery& query = asked.queries[i];
      different[query.method] += answers[i] != answerBias(fitted.map, query) ? 1 : 0;
      unknown[query.method] += answers[i] == kAnswerUnknown ? 1 : 0;
    }
    for (const int method : methods) {
      EXPECT_LE(different[method], isLavapipe() ? 0 : answers.size() / 1000) << "method " << method;
      EXPECT_EQ(unknown[method], method == kNoSuchBias ? 4 * asked.cases.at(method) : 0) << "method " << method;
    }
  }
  EXPECT_EQ(names.size(), parameterizations().size());
}

}  // namespace
}  // namespace gnomon
