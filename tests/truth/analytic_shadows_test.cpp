// Labels on scenes whose answer is known on paper.

#include "scenes_by_hand.h"
#include "shot.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// --- A lone plane --------------------------------------------------------------------------------------

struct Tilt {
  bool directional;
  double degrees;
};

void PrintTo(const Tilt& tilt, std::ostream* out) {
  *out << (tilt.directional ? "directional " : "spot ") << tilt.degrees;
}

class LonePlane : public testing::TestWithParam<Tilt> {
 protected:
  // The plane through the origin is tilted about an axis that is aligned with nothing; the light hangs 6 m above it.
  Shot shoot() const {
    Scene scene = emptyScene();
    addFloor(scene, 0.0, 60.0);
    moveAll(scene, glm::rotate(glm::dmat4(1.0), GetParam().degrees * kDegree, glm::normalize(glm::dvec3(2, 0.3, 1))));
    const LightModel light =
        GetParam().directional ? directionalLight({0.1, -1.0, 0.05}) : pointLight({0.3, 6.0, -0.2});
    return takeShot(std::move(scene), viewFrom({0.5, 5.0, 0.4}, {0, 0, 0}, 0.5, 200, 200), light);
  }
  ReferenceMap map(const Shot& shot) const {
    return traceReferenceMap(*shot.tracer, shot.light,
                             {.targetW = {0, 0, 0},
                              .halfExtent = GetParam().directional ? 8.0 : 0.8,
                              .side = 96,
                              .near = GetParam().directional ? 1.0 : 0.2,
                              .far = GetParam().directional ? 80.0 : 60.0});
  }
};

TEST_P(LonePlane, NeverHasAnEdgeOrALeakAndIsAllLit) {
  const Shot shot = shoot();
  ASSERT_GT(shot.receivers.scored, 30000u);
  EXPECT_EQ(shot.truth.litCount, shot.receivers.scored);
  EXPECT_EQ(shot.truth.marginFlipsHalf + shot.truth.marginFlipsDouble, 0u);
  const ReferenceMap reference = map(shot);
  for (const int method : {glsl::kBiasNone, glsl::kBiasConstant, glsl::kBiasSlope, glsl::kBiasAdaptive}) {
    const LabelImage image = labelShot(shot, reference, method, defaultBias(method));
    EXPECT_EQ(image.count(Label::EdgeShadow) + image.count(Label::EdgeLight) + image.count(Label::Leak), 0u)
        << "method " << method << ": " << showCounts(image);
  }
}

// The plane's depth grows in one direction across a texel; the half beyond the centre is deeper than what is stored.
TEST_P(LonePlane, WithoutBiasHasAcneOnHalfOfItsPixels) {
  const Shot shot = shoot();
  const LabelImage image = labelShot(shot, map(shot), glsl::kBiasNone, defaultBias(glsl::kBiasNone));
  const double asked = static_cast<double>(image.count(Label::Agree) + image.count(Label::Acne));
  EXPECT_NEAR(static_cast<double>(image.count(Label::Acne)) / asked, 0.5, 0.03) << showCounts(image);
}

TEST_P(LonePlane, WithAdaptiveBiasHasNoAcne) {
  const Shot shot = shoot();
  const LabelImage image = labelShot(shot, map(shot), glsl::kBiasAdaptive, defaultBias(glsl::kBiasAdaptive));
  EXPECT_EQ(image.count(Label::Acne), 0u) << showCounts(image);
  // The steepest plane leaves the window by a corner.
  EXPECT_EQ(image.count(Label::Agree) + image.count(Label::Uncovered), shot.receivers.scored);
  EXPECT_LT(image.count(Label::Uncovered), shot.receivers.scored / 50);
}

INSTANTIATE_TEST_SUITE_P(Tilts, LonePlane,
                         testing::Values(Tilt{false, 7}, Tilt{false, 30}, Tilt{false, 55}, Tilt{false, 70},
                                         Tilt{true, 5}, Tilt{true, 33}, Tilt{true, 60}, Tilt{true, 75}));

// --- Detachment ----------------------------------------------------------------------------------------

// A box [0,w] x [0,h] x [-l,l] on the floor y = 0. Light comes from -x at the elevation e. It reaches the
// floor at x = w + u through the face x = 0, which the map holds, (w + u) / cos e metres before the floor, as
// long as w + u < h / tan e. A constant bias of b metres steps over that face where (w + u) / cos e < b:
//
//      \  light                     u
//       \  +--+                 |<------>|
//        \ |  |            leak where 0 < u < b cos e - w: a strip of 2 l (b cos e - w) square metres
//   ______\|__|___________________________ x
//          0  w
TEST(Detachment, LeakHasTheAreaThatTheConstantBiasOpens) {
  const double w = 0.2, h = 2.0, l = 1.5, b = 1.0, e = 45.0 * kDegree;
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 12.0);
  addBox(scene, {0, 0, -l}, {w, h, l});
  const LightModel light = directionalLight({std::cos(e), -std::sin(e), 0});
  const glsl::CameraView camera = viewFrom({1.2, 9.0, 0.02}, {0.7, 0.0, 0.0}, 0.7, 400, 400);
  const Shot shot = takeShot(std::move(scene), camera, light);
  const MapWindow window{.targetW = {0.5, 0, 0}, .halfExtent = 4.0, .side = 512, .near = 0.5, .far = 30.0};
  const ReferenceMap map = traceReferenceMap(*shot.tracer, light, window);
  glsl::BiasParams params = defaultBias(glsl::kBiasConstant);
  params.knobs[glsl::kConstantOffset] = static_cast<float>(b);
  const LabelImage image = labelShot(shot, map, glsl::kBiasConstant, params);

  // Square metres of floor a pixel covers: its solid angle, times distance squared, over the cosine at the floor.
  const double pixelArea =
      4.0 * static_cast<double>(camera.tanHalfX) * static_cast<double>(camera.tanHalfY) / (400.0 * 400.0);
  double area = 0.0;
  size_t outside = 0;
  const double texel = 2.0 * window.halfExtent / window.side;
  const double stray = texel * (1.0 / std::sin(e) + 1.0 / std::cos(e));  // of u, when the texel's centre is asked
  for (size_t i = 0; i < image.labels.size(); ++i) {
    if (image.labels[i] != Label::Leak) continue;
    const glm::dvec3 p = shot.receivers.samples[i].positionW;
    const glm::dvec3 dir = pixelDirectionD(camera, static_cast<int>(i % 400), static_cast<int>(i / 400));
    const double t = (p.y - static_cast<double>(camera.eyeW.y)) / dir.y;
    if (p.y < 1e-6) area += pixelArea * t * t / std::abs(dir.y);
    const double u = p.x - w;
    outside += p.y < 1e-6 && (u < -1e-6 || u > b * std::cos(e) - w + stray || std::abs(p.z) > l + texel) ? 1 : 0;
  }
  const double expected = 2.0 * l * (b * std::cos(e) - w);
  // The strip's far border lies within half a texel's stray; a pixel is 1.6 cm wide and counts as a whole.
  const double pixelWidth = std::sqrt(pixelArea) * 9.0;
  const double perimeter = 2.0 * (2.0 * l + b * std::cos(e) - w);
  EXPECT_NEAR(area, expected, perimeter * (0.5 * stray + 0.05 * pixelWidth));
  EXPECT_EQ(outside, 0u);
  EXPECT_GT(image.count(Label::Leak), 1000u);
}

// The same without the bias's help: adaptive keeps the contact.
TEST(Detachment, AdaptiveLeaksNothingAtABoxOnAFloor) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 12.0);
  addBox(scene, {0, 0, -1.5}, {0.2, 2, 1.5});
  const LightModel light = directionalLight({1, -1, 0});
  const Shot shot = takeShot(std::move(scene), viewFrom({1.2, 9.0, 0.02}, {0.7, 0.0, 0.0}, 0.7, 300, 300), light);
  const ReferenceMap map = traceReferenceMap(
      *shot.tracer, light, {.targetW = {0.5, 0, 0}, .halfExtent = 4.0, .side = 512, .near = 0.5, .far = 30.0});
  const LabelImage image = labelShot(shot, map, glsl::kBiasAdaptive, defaultBias(glsl::kBiasAdaptive));
  // Adaptive's own epsilon, sceneScale * K = 3.4 mm along the ray, opens a strip narrower than a pixel (2.2 cm).
  EXPECT_LE(image.count(Label::Leak), 300u) << showCounts(image);
  EXPECT_GT(image.count(Label::Agree), shot.receivers.scored * 9 / 10);
}

// --- A silhouette --------------------------------------------------------------------------------------

double distanceToLine(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b) {
  const glm::dvec2 along = b - a;
  const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::length(p - (a + along * t));
}

class FloatingPlate : public testing::TestWithParam<bool> {};

// A projective map keeps lines straight, so the plate's outline in texels is four segments, and only a pixel
// whose texel holds a piece of outline can be wrong: within half a diagonal of its texel's centre, so within
// a whole one of itself.
TEST_P(FloatingPlate, GivesEdgesOfATexelAndNeitherAcneNorLeak) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 15.0);
  const glm::dvec3 corners[4] = {{-0.9, 2.0, 0.8}, {1.1, 2.1, 0.6}, {0.8, 1.9, -0.9}, {-0.7, 1.8, -0.6}};
  addTriangle(scene, corners[0], corners[1], corners[2]);
  addTriangle(scene, corners[0], corners[2], corners[3]);
  const LightModel light = GetParam() ? directionalLight({0.3, -1, 0.2}) : pointLight({0.2, 6.0, 0.1});
  const Shot shot = takeShot(std::move(scene), viewFrom({3.0, 6.0, 5.0}, {0.5, 0, 0}, 0.8, 300, 300), light);
  const ReferenceMap map = traceReferenceMap(
      *shot.tracer, light,
      {.targetW = {0, 0, 0}, .halfExtent = GetParam() ? 6.0 : 1.2, .side = 64, .near = 0.5, .far = 30.0});
  const LabelImage image = labelShot(shot, map, glsl::kBiasAdaptive, defaultBias(glsl::kBiasAdaptive));
  EXPECT_EQ(image.count(Label::Acne), 0u) << showCounts(image);
  EXPECT_EQ(image.count(Label::Leak), 0u) << showCounts(image);
  EXPECT_GT(image.count(Label::EdgeShadow), 100u);
  EXPECT_GT(image.count(Label::EdgeLight), 100u);

  size_t band = 0;
  for (size_t i = 0; i < image.labels.size(); ++i) {
    if (shot.receivers.states[i] != PixelState::Scored) continue;
    const glm::dvec2 texel = map.texelOf(shot.receivers.samples[i].positionW);
    double nearest = 1e9;
    for (int k = 0; k < 4; ++k) {
      nearest = std::min(nearest, distanceToLine(texel, map.texelOf(corners[k]), map.texelOf(corners[(k + 1) % 4])));
    }
    const bool wrong = image.labels[i] == Label::EdgeShadow || image.labels[i] == Label::EdgeLight;
    const double bound = 0.5 * std::numbers::sqrt2 + 1e-3;
    band += nearest <= bound ? 1 : 0;
    EXPECT_TRUE(!wrong || nearest <= bound) << nearest << " texels from the outline";
  }
  EXPECT_LT(image.count(Label::EdgeShadow) + image.count(Label::EdgeLight), band);
}

INSTANTIATE_TEST_SUITE_P(Lights, FloatingPlate, testing::Bool());

// --- A concave corner ----------------------------------------------------------------------------------

// Where a coarse texel's centre lies on the other wall, the receiver's plane extended to its ray is behind
// that wall: adaptive calls it shadow. Nothing casts one, so this is acne and no edge.
TEST(ConcaveCorner, UnderACoarseMapHasAcneAndNoEdge) {
  Scene scene = emptyScene();
  addQuad(scene, {0, 0, -20}, {0, 0, 20}, {20, 0, 20}, {20, 0, -20});
  addQuad(scene, {0, 0, -20}, {0, 20, -20}, {0, 20, 20}, {0, 0, 20});
  const LightModel light = pointLight({3.0, 2.5, 0.2});
  const Shot shot = takeShot(std::move(scene), viewFrom({4, 4, 1}, {0, 0, 0}, 0.7, 300, 300), light);
  EXPECT_EQ(shot.truth.litCount, shot.receivers.scored);
  const ReferenceMap map = traceReferenceMap(
      *shot.tracer, light, {.targetW = {0, 0, 0.3}, .halfExtent = 1.0, .side = 17, .near = 0.2, .far = 40.0});
  const LabelImage image = labelShot(shot, map, glsl::kBiasAdaptive, defaultBias(glsl::kBiasAdaptive));
  EXPECT_GT(image.count(Label::Acne), 300u) << showCounts(image);
  EXPECT_EQ(image.count(Label::EdgeShadow) + image.count(Label::EdgeLight) + image.count(Label::Leak), 0u)
      << showCounts(image);
}

// --- Bookkeeping ---------------------------------------------------------------------------------------

TEST(Labels, AddUpToTheScoredPixels) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 10.0);
  addBox(scene, {-1, 0, -1}, {1, 1, 1});
  addSphere(scene, {2, 1.5, 0}, 0.7, 16, 24);
  LightModel light = pointLight({0.3, 5.0, 0.2});
  light.type = LightType::Spot;
  light.directionW = {0, -1, 0};
  light.outerConeRad = 0.9;
  const Shot shot = takeShot(std::move(scene), viewFrom({4, 4, 6}, {0, 0, 0}, 0.9, 200, 160), light);
  EXPECT_GT(shot.receivers.facingAway, 0u);
  EXPECT_GT(shot.receivers.outsideCone, 0u);
  // A window smaller than the cone, so that some pixels are uncovered.
  const ReferenceMap map = traceReferenceMap(*shot.tracer, light, {.targetW = {0.3, 0, 0.2}, .halfExtent = 0.7});
  for (const int method : {glsl::kBiasNone, glsl::kBiasConstant, glsl::kBiasSlope, glsl::kBiasAdaptive}) {
    const LabelImage image = labelShot(shot, map, method, defaultBias(method));
    size_t sum = 0;
    for (int i = 1; i < kLabelCount; ++i) sum += image.count(static_cast<Label>(i));
    EXPECT_EQ(sum, shot.receivers.scored);
    EXPECT_EQ(image.count(Label::NotScored), image.labels.size() - shot.receivers.scored);
    EXPECT_GT(image.count(Label::Uncovered), 0u);
    EXPECT_STREQ(labelName(Label::EdgeShadow), "edge_shadow");
  }
}

}  // namespace
}  // namespace gnomon::test
