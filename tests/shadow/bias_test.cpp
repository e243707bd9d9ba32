// shared/bias.glsl: what each method promises. bias_on_the_gpu_test.cpp has the same verdicts on both processors.
#include "base/error.h"
#include "plane_case.h"

#include <cmath>
#include <numbers>
#include <set>

namespace gnomon {
namespace {

using namespace glsl;
using test::facingNormal;
using test::fittedDirectional;
using test::fittedSpot;
using test::MapSample;
using test::PlaneCase;
using test::planeCase;
using test::samplesOf;

std::vector<PlaneCase> planeCases(const ShadowMap& map, const FittedMap& fitted, size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<PlaneCase> cases;
  for (const MapSample& sample : samplesOf(fitted, count, 12)) {
    const float tanAngle = std::tan(unit(random) * 1.55f);  // to 88.8 degrees
    const PlaneCase c = planeCase(map, sample, tanAngle, unit(random) * 2.0f * std::numbers::pi_v<float>);
    if (c.meets) cases.push_back(c);
  }
  return cases;
}

bool lit(int method, const ShadowMap& map, const BiasParams& params, const Receiver& receiver, const Tap& tap) {
  bool known = false;
  const bool result = biasLit(method, map, params, receiver, tap, known);
  EXPECT_TRUE(known);
  return result;
}

class Bias : public ::testing::TestWithParam<bool> {
 protected:
  FittedMap fitted_ = GetParam() ? fittedSpot() : fittedDirectional();

  BiasParams paramsOf(const char* bias) const { return defaultBiasParams(findBias(bias), fitted_.map.sceneScale); }
};

TEST_P(Bias, AdaptiveNeverShadowsAPlaneByItself) {
  const auto cases = planeCases(fitted_.map, fitted_, 1 << 16);
  ASSERT_GT(cases.size(), size_t{40000});
  BiasParams params = paramsOf("adaptive");
  for (const int epsilonAt : {kEpsilonAtFragment, kEpsilonAtOccluder, kEpsilonAtStored}) {
    params.epsilonAt = epsilonAt;
    size_t acne = 0;
    for (const PlaneCase& c : cases) acne += lit(kBiasAdaptive, fitted_.map, params, c.receiver, c.tap) ? 0 : 1;
    EXPECT_EQ(acne, 0u) << "epsilon at " << kEpsilonAt.text(params);
  }
}

TEST_P(Bias, NoneShadowsAboutHalfOfATiltedPlane) {
  size_t acne = 0;
  const auto cases = planeCases(fitted_.map, fitted_, 1 << 14);
  for (const PlaneCase& c : cases) acne += lit(kBiasNone, fitted_.map, {}, c.receiver, c.tap) ? 0 : 1;
  EXPECT_NEAR(static_cast<double>(acne) / static_cast<double>(cases.size()), 0.5, 0.03);
}

// Factor 2 covers a whole texel in the steeper of the two directions; a corner of the texel may lie 1.41 of
// that away, never more than twice half a texel's change in u plus in v.
TEST_P(Bias, SlopeCoversATiltedPlane) {
  size_t acne = 0;
  const auto cases = planeCases(fitted_.map, fitted_, 1 << 14);
  const BiasParams params = paramsOf("slope");
  for (const PlaneCase& c : cases) acne += lit(kBiasSlope, fitted_.map, params, c.receiver, c.tap) ? 0 : 1;
  EXPECT_LE(static_cast<double>(acne) / static_cast<double>(cases.size()), 0.01);
}

TEST_P(Bias, ConstantIsADistanceInMetres) {
  BiasParams params = paramsOf("constant");
  size_t tried = 0;
  for (const MapSample& sample : samplesOf(fitted_, 4096, 13)) {
    PlaneCase c = planeCase(fitted_.map, sample, 0.0f, 0.0f);
    const float distance = glm::dot(c.receiver.posL - c.tap.ray.origin, c.tap.ray.dir);
    for (const float gap : {0.05f, 0.2f}) {
      if (distance <= 2.0f * gap) continue;
      c.tap.z1 = mapDepth(fitted_.map, 0, c.receiver.posL - c.tap.ray.dir * gap);
      params.knobs[kConstantOffset] = 0.98f * gap;
      EXPECT_FALSE(lit(kBiasConstant, fitted_.map, params, c.receiver, c.tap));
      params.knobs[kConstantOffset] = 1.02f * gap;
      EXPECT_TRUE(lit(kBiasConstant, fitted_.map, params, c.receiver, c.tap));
      ++tried;
    }
  }
  EXPECT_GT(tried, size_t{2 * 4096 * 3 / 4});
}

TEST_P(Bias, AnOccluderTenEpsilonsAwayCastsAShadowWithAdaptive) {
  const BiasParams params = paramsOf("adaptive");
  size_t tried = 0;
  for (const PlaneCase& c : planeCases(fitted_.map, fitted_, 4096)) {
    Tap tap = c.tap;
    const float t = rayPlaneDistance(tap.ray, c.receiver.posL, c.receiver.normalL);
    const float gap = 10.0f * params.knobs[kAdaptiveK] * fitted_.map.sceneScale;
    if (t < 2.0f * gap) continue;
    tap.z1 = mapDepth(fitted_.map, 0, tap.ray.origin + tap.ray.dir * (t - gap));
    EXPECT_FALSE(lit(kBiasAdaptive, fitted_.map, params, c.receiver, tap));
    ++tried;
  }
  EXPECT_GT(tried, size_t{2000});
}

TEST_P(Bias, AnEmptyTexelLightsWithEveryMethod) {
  for (const MapSample& sample : samplesOf(fitted_, 64, 14)) {
    PlaneCase c = planeCase(fitted_.map, sample, 3.0f, 1.0f);
    c.tap.z1 = 1.0f;
    for (const BiasMethod& method : biasMethods()) {
      if (method.knowsSurfaces()) continue;
      EXPECT_TRUE(lit(method.id, fitted_.map, paramsOf(method.name), c.receiver, c.tap)) << method.name;
    }
  }
}

// Weiskopf & Ertl 2003: with an offset beyond every gap dual is midpoint, and where half the gap is beyond
// the offset it is the constant bias; to the bit.
TEST_P(Bias, MidpointAndConstantAreTheLimitsOfDual) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  BiasParams dualParams = paramsOf("dual"), constantParams = paramsOf("constant");
  size_t decidedByGap = 0, litCount = 0;
  const auto cases = planeCases(fitted_.map, fitted_, 1 << 14);
  for (const PlaneCase& c : cases) {
    Tap tap = c.tap;
    const float distance = mapDistance(fitted_.map, 0, tap.ray, tap.z1);
    const float gap = 2.0f * unit(random);  // metres
    tap.z1 = mapDepth(fitted_.map, 0, tap.ray.origin + tap.ray.dir * std::max(distance - 0.5f * unit(random), 0.0f));
    tap.z2 = mapDepth(fitted_.map, 0, tap.ray.origin + tap.ray.dir * (distance + gap));
    const bool midpoint = lit(kBiasMidpoint, fitted_.map, {}, c.receiver, tap);
    dualParams.knobs[kDualOffset] = 1e6f;
    EXPECT_EQ(lit(kBiasDual, fitted_.map, dualParams, c.receiver, tap), midpoint);

    dualParams.knobs[kDualOffset] = 0.25f;
    constantParams.knobs[kConstantOffset] = 0.25f;
    const bool dual = lit(kBiasDual, fitted_.map, dualParams, c.receiver, tap);
    if (halfLayerGap(fitted_.map, tap) > 0.25f) {
      EXPECT_EQ(dual, lit(kBiasConstant, fitted_.map, constantParams, c.receiver, tap));
    } else {
      EXPECT_EQ(dual, midpoint);
      ++decidedByGap;
    }
    litCount += dual ? 1 : 0;
  }
  EXPECT_GT(decidedByGap, cases.size() / 20);
  EXPECT_GT(litCount, cases.size() / 20);
  EXPECT_LT(litCount, cases.size() - cases.size() / 20);
}

// Equation 2 of Weiskopf & Ertl 2003: the shadowing surface stands half way between the layers.
TEST_P(Bias, MidpointIsHalfWayBetweenTheLayers) {
  size_t tried = 0;
  for (const PlaneCase& c : planeCases(fitted_.map, fitted_, 4096)) {
    const Ray ray = c.tap.ray;
    const float at = mapDistance(fitted_.map, 0, ray, mapDepth(fitted_.map, 0, c.receiver.posL));
    const float length = mapDistance(fitted_.map, 0, ray, 1.0f);
    const float gap = 0.5f;  // metres
    if (at < gap || at + gap > length) continue;
    for (const float share : {0.45f, 0.55f}) {  // of the gap, before the receiver
      Tap tap = c.tap;
      tap.z1 = mapDepth(fitted_.map, 0, ray.origin + ray.dir * (at - share * gap));
      tap.z2 = mapDepth(fitted_.map, 0, ray.origin + ray.dir * (at - share * gap + gap));
      EXPECT_EQ(lit(kBiasMidpoint, fitted_.map, {}, c.receiver, tap), share < 0.5f);
    }
    ++tried;
  }
  EXPECT_GT(tried, size_t{500});
}

// In a planar map a plane's depth is affine in (u, v), so its gradient leads to the very point the adaptive
// bias intersects.
TEST_P(Bias, ReceiverPlaneNeverShadowsAPlaneByItself) {
  size_t acne = 0;
  const auto cases = planeCases(fitted_.map, fitted_, 1 << 14);
  const BiasParams params = paramsOf("receiver-plane");
  for (const PlaneCase& c : cases) acne += lit(kBiasReceiverPlane, fitted_.map, params, c.receiver, c.tap) ? 0 : 1;
  // The rest are planes so steep that a ray one texel on does not meet them between near and far.
  EXPECT_LE(static_cast<double>(acne) / static_cast<double>(cases.size()), 0.01);
}

// Depths around where adaptive turns: from one epsilon beyond the plane's to twice that nearer to the light.
TEST_P(Bias, ClampingAndEhmLightWhateverAdaptiveLightsAndMore) {
  const BiasParams params = paramsOf("adaptive");  // all three share its knob
  std::mt19937 random(20);
  std::uniform_real_distribution<float> epsilons(-1.0f, 2.0f);
  size_t adaptive = 0, clampedOnly = 0, ehmOnly = 0;
  const auto cases = planeCases(fitted_.map, fitted_, 1 << 14);
  for (const PlaneCase& c : cases) {
    Tap tap = c.tap;
    const PlaneDepth plane = receiverPlaneDepth(fitted_.map, 0, c.receiver, tap.ray);
    tap.z1 -= epsilons(random) * adaptiveEpsilon(fitted_.map, params, c.receiver, tap, plane.posL);
    const bool clamped = lit(kBiasAdaptiveClamped, fitted_.map, params, c.receiver, tap);
    const bool ehm = lit(kBiasAdaptiveEhm, fitted_.map, params, c.receiver, tap);
    if (lit(kBiasAdaptive, fitted_.map, params, c.receiver, tap)) {
      ++adaptive;
      EXPECT_TRUE(clamped);
      EXPECT_TRUE(ehm);
    } else {
      clampedOnly += clamped ? 1 : 0;
      ehmOnly += ehm ? 1 : 0;
    }
  }
  const auto share = [&](size_t count) { return static_cast<double>(count) / static_cast<double>(cases.size()); };
  EXPECT_NEAR(share(adaptive), 2.0 / 3.0, 0.02);  // up to one epsilon of -1 to 2
  // Of the last third: every other plane's F' lies behind the receiver, which clamping does not take.
  EXPECT_NEAR(share(clampedOnly), 1.0 / 6.0, 0.02);
  // Ehm's epsilon is 1 + tan^2 of the angle a times as large, and a is even up to 1.55: of s from 1 to 2 epsilons those
  // with a >= atan(sqrt(s - 1)), whose mean is pi / 2 - 1.
  EXPECT_NEAR(share(ehmOnly), (1.0 - (std::numbers::pi / 2.0 - 1.0) / 1.55) / 3.0, 0.02);
}

TEST_P(Bias, CosineIsNothingWhereTheSurfaceFacesTheLight) {
  BiasParams params = paramsOf("cosine");
  size_t tried = 0;
  for (const MapSample& sample : samplesOf(fitted_, 512, 18)) {
    PlaneCase c = planeCase(fitted_.map, sample, 0.0f, 0.0f);
    c.receiver.normalL = -c.tap.ray.dir;
    const float distance = glm::dot(c.receiver.posL - c.tap.ray.origin, c.tap.ray.dir);
    if (distance < 0.2f) continue;
    params.knobs[kCosineOffset] = 1.0f;
    c.tap.z1 = mapDepth(fitted_.map, 0, c.receiver.posL - c.tap.ray.dir * 0.05f);
    EXPECT_FALSE(lit(kBiasCosine, fitted_.map, params, c.receiver, c.tap));
    c.receiver.normalL = facingNormal(c.tap.ray.dir, 30.0f, 1.0f);
    EXPECT_TRUE(lit(kBiasCosine, fitted_.map, params, c.receiver, c.tap));
    ++tried;
  }
  EXPECT_GT(tried, size_t{512 * 3 / 4});
}

TEST_P(Bias, NormalOffsetMovesTexelsAlongTheNormal) {
  BiasParams params = paramsOf("normal-offset");
  size_t tried = 0;
  for (const MapSample& sample : samplesOf(fitted_, 512, 19)) {
    if (std::abs(sample.uv.x - 0.5f) > 0.45f || std::abs(sample.uv.y - 0.5f) > 0.45f) continue;  // moved off the map
    const Ray ray = mapTexelRay(fitted_.map, 0, sample.uv);
    const Receiver receiver{sample.posL, facingNormal(ray.dir, 1.0f, 2.0f)};  // 45 degrees
    params.knobs[kNormalOffsetTexels] = 2.0f;
    const Receiver moved = normalOffsetReceiver(fitted_.map, params, receiver);
    const vec3 by = moved.posL - receiver.posL;
    EXPECT_GT(glm::dot(by, receiver.normalL), 0.0f);
    EXPECT_NEAR(glm::length(by - receiver.normalL * glm::dot(by, receiver.normalL)), 0.0f, 1e-5f);
    // Two texels times sin 45: as far as 1.4 texels across the map, to the obliqueness of rays off the axis.
    const Ray next = mapTexelRay(fitted_.map, 0, vec2(sample.uv.x + 1.0f / 256.0f, sample.uv.y));
    const float along = glm::dot(sample.posL - ray.origin, ray.dir);
    const float texel = glm::length((next.origin + next.dir * along) - (ray.origin + ray.dir * along));
    EXPECT_NEAR(glm::length(by) / texel, std::sqrt(2.0f), 0.01f);
    ++tried;
  }
  EXPECT_GT(tried, size_t{512 * 3 / 4});  // of the samples 0.9 * 0.9
}

// What the map holds of a receiver's own plane where a moved receiver is looked up.
Tap planeTapOf(const ShadowMap& map, const Receiver& plane, const Receiver& moved) {
  const MapPoint point = mapProject(map, moved.posL);
  const ivec2 texel = mapTexel(map, point.uv);
  Tap tap = emptyTap(point.slice, texel, mapTexelRay(map, point.slice, mapTexelCenter(map, texel)));
  tap.z1 = receiverPlaneDepth(map, tap.slice, plane, tap.ray).depth;
  return tap;
}

// Share of tilted planes that shadow themselves.
double acneShare(const FittedMap& fitted, const std::vector<PlaneCase>& cases, int method) {
  size_t acne = 0;
  for (const PlaneCase& c : cases) {
    const Receiver moved = biasReceiver(method, fitted.map, {}, c.receiver);
    acne += lit(method, fitted.map, {}, moved, planeTapOf(fitted.map, c.receiver, moved)) ? 0 : 1;
  }
  return static_cast<double>(acne) / static_cast<double>(cases.size());
}

TEST_P(Bias, WhatEnginesDoMostlyCoversATiltedPlane) {
  const auto cases = planeCases(fitted_.map, fitted_, 1 << 14);
  const double none = acneShare(fitted_, cases, kBiasNone);
  EXPECT_NEAR(none, 0.5, 0.03);
  // Twice the very change from the receiver to the texel, and half a texel's diagonal besides its slope: all but planes
  // that change by more than a metre within a texel, or graze.
  EXPECT_LE(acneShare(fitted_, cases, kBiasUnrealVsm), 0.02);
  EXPECT_LE(acneShare(fitted_, cases, kBiasEevee), 0.02);
  EXPECT_LE(acneShare(fitted_, cases, kBiasBevy), 0.5 * none);
  EXPECT_LE(acneShare(fitted_, cases, kBiasGodot), 0.5 * none);
}

// Facing the light, where no plane changes depth: what is left is what the engine adds.
TEST_P(Bias, WhatEnginesAddIsADistance) {
  const FittedMap& f = fitted_;
  size_t tried = 0;
  for (const MapSample& sample : samplesOf(f, 1024, 21)) {
    PlaneCase c = planeCase(f.map, sample, 0.0f, 0.0f);
    c.receiver.normalL = -c.tap.ray.dir;
    const float distance = glm::dot(c.receiver.posL - c.tap.ray.origin, c.tap.ray.dir);
    const auto litBehindGap = [&](int method, float gap) {
      const Receiver moved = biasReceiver(method, f.map, {}, c.receiver);
      Tap tap = planeTapOf(f.map, c.receiver, moved);
      tap.z1 = mapDepth(f.map, 0, c.receiver.posL - c.tap.ray.dir * gap);
      return lit(method, f.map, {}, moved, tap);
    };
    const float reach = glm::length(c.receiver.posL);
    const Ray axis = mapTexelRay(f.map, 0, glm::vec2(0.5f));
    const float range = glm::length(axis.origin) + mapDistance(f.map, 0, axis, 1.0f);
    const float added = 0.0003f * range / 0.025f;  // of a spot light: what the engine adds, where r is large
    const float godot = GetParam() ? added * reach / (reach + added) : 0.001f;
    const MapPoint point = mapProject(f.map, c.receiver.posL);
    const float texel = texelWidthAt(f.map, point, mapTexelRay(f.map, 0, point.uv), c.receiver.posL);
    const float bevy = 0.02f + 1.8f * std::sqrt(2.0f) * texel;
    if (distance < 2.0f * std::max(godot, bevy)) continue;
    EXPECT_TRUE(litBehindGap(kBiasGodot, 0.9f * godot));
    EXPECT_FALSE(litBehindGap(kBiasGodot, 1.1f * godot));
    EXPECT_TRUE(litBehindGap(kBiasBevy, 0.9f * bevy));
    EXPECT_FALSE(litBehindGap(kBiasBevy, 1.1f * bevy));
    if (!GetParam()) {  // of a spot map such planes change depth
      EXPECT_FALSE(litBehindGap(kBiasUnrealVsm, 0.0005f * mapDistance(f.map, 0, c.tap.ray, 1.0f)));
    }
    ++tried;
  }
  EXPECT_GT(tried, size_t{512});
}

INSTANTIATE_TEST_SUITE_P(Kinds, Bias, ::testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Spot" : "Directional"; });

TEST(BiasList, HasEveryIdOnceAndDefaultsWithinTheirRanges) {
  std::set<int> ids;
  for (const BiasMethod& method : biasMethods()) {
    EXPECT_TRUE(ids.insert(method.id).second) << method.name;
    for (const Knob& knob : method.knobs) {
      EXPECT_LE(knob.lower, knob.defaultValue) << method.name << " " << knob.name;
      EXPECT_GE(knob.upper, knob.defaultValue) << method.name << " " << knob.name;
      EXPECT_NE(*knob.sentence, '\0');
    }
  }
}

TEST(BiasList, RefusesAnUnknownNameAndListsTheOthers) {
  try {
    parseBiases("adaptive,adaptve");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("adaptve: no such bias"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("slope"), std::string::npos);
  }
}

TEST(BiasList, UnknownMethodIsTold) {
  bool known = true;
  const FittedMap fitted = fittedSpot();
  Tap tap = emptyTap(0, {}, {});
  tap.z1 = 0.5f;
  biasLit(999, fitted.map, {}, {}, tap, known);
  EXPECT_FALSE(known);
}

}  // namespace
}  // namespace gnomon
