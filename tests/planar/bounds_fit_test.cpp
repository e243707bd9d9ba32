// Maps of a renderer that has no scene on the CPU: bounds, a light and a camera.
#include "planar/planar_map.h"
#include "scene/gbuffer.h"
#include "scene/generate.h"
#include "scene/receiver_picture.h"
#include "shared/map.glsl"

#include <gtest/gtest.h>

#include <random>

namespace gnomon {
namespace {

using namespace glsl;

constexpr double kNear = 0.05;
const Bounds kBounds{glm::vec3(-4.0f, -1.0f, -6.0f), glm::vec3(5.0f, 7.0f, 3.0f)};

LightModel spotIn(const glm::dvec3& positionW) {
  return {.type = LightType::Spot,
          .positionW = positionW,
          .directionW = glm::normalize(glm::dvec3(0.4, -1.0, -0.3)),
          .outerConeRad = 0.7};
}

LightModel sun() {
  return {.type = LightType::Directional, .directionW = glm::normalize(glm::dvec3(-0.5, -1.0, 0.2))};
}

// Points within the bounds, and on their corners.
std::vector<glm::dvec3> pointsIn(const Bounds& bounds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<glm::dvec3> points;
  const glm::dvec3 size(bounds.upper - bounds.lower);
  for (int i = 0; i < 20000; ++i)
    points.push_back(glm::dvec3(bounds.lower) + size * glm::dvec3(unit(random), unit(random), unit(random)));
  for (int i = 0; i < 8; ++i)
    points.push_back(glm::dvec3(bounds.lower) + size * glm::dvec3(i & 1, (i >> 1) & 1, (i >> 2) & 1));
  return points;
}

bool inCone(const LightModel& light, const glm::dvec3& pointW) {
  const glm::dvec3 towards = pointW - light.positionW;
  return glm::dot(towards, light.directionW) > std::cos(light.outerConeRad) * glm::length(towards);
}

bool seenBy(const CameraView& camera, const glm::dvec3& pointW) {
  const glm::dvec4 clip = glm::dmat4(camera.clipFromWorld) * glm::dvec4(pointW, 1.0);
  return clip.w > 0.1 && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w;
}

struct Place {
  bool covered = false;
  double depth = 0.0;
};
Place placeOf(const FittedMap& fitted, const glm::dvec3& pointW) {
  const glm::vec3 posL = lightFromWorld(fitted.frame, glm::vec3(pointW));
  const MapPoint point = mapProject(fitted.map, posL);
  return {point.covered, point.covered ? mapDepth(fitted.map, point.slice, posL) : 0.0};
}

// One over the area of the plane that a window holds.
double scaleOf(const FittedMap& fitted) {
  const glm::mat4& m = fitted.map.mapSlices[0].clipFromLight;
  return std::abs(static_cast<double>(m[0][0]) * m[1][1]);
}

TEST(BoundsFit, ASpotMapHoldsWhatOfTheBoundsIsInItsCone) {
  for (const glm::dvec3& at : {glm::dvec3(0.0, 6.0, 0.0), glm::dvec3(-6.0, 12.0, 2.0)}) {  // within them, and outside
    const LightModel light = spotIn(at);
    const FittedMap fitted = makeSpotMap(light, {.boundsW = kBounds, .side = 256, .zNear = kNear});
    size_t tried = 0;
    for (const glm::dvec3& point : pointsIn(kBounds)) {
      if (!inCone(light, point) || glm::dot(point - at, light.directionW) < 1.001 * kNear) continue;
      const Place place = placeOf(fitted, point);
      ASSERT_TRUE(place.covered);
      ASSERT_GE(place.depth, 0.0);
      ASSERT_LE(place.depth, 1.0);
      ++tried;
    }
    EXPECT_GT(tried, size_t{1000});
  }
}

TEST(BoundsFit, ADirectionalMapHoldsTheBounds) {
  const FittedMap fitted = makeDirectionalMap(sun(), {.boundsW = kBounds, .side = 256});
  double nearest = 1.0, farthest = 0.0;
  for (const glm::dvec3& point : pointsIn(kBounds)) {
    const Place place = placeOf(fitted, point);
    ASSERT_TRUE(place.covered);
    ASSERT_GE(place.depth, 0.0);
    ASSERT_LE(place.depth, 1.0);
    nearest = std::min(nearest, place.depth);
    farthest = std::max(farthest, place.depth);
  }
  EXPECT_LT(nearest, 0.01);   // corners are among the points: the range is theirs,
  EXPECT_GT(farthest, 0.89);  // but for a step of the series that a snapped range takes
}

// A camera narrows the window to what it sees; what throws shadows there from anywhere in the bounds has a depth still.
TEST(BoundsFit, ACameraNarrowsTheWindowAndLosesNoCaster) {
  const CameraView camera = cameraView(lookAt("c", {3.0f, 2.0f, 2.0f}, {0.0f, 0.5f, -2.0f}, 0.5f), 64, 64);
  for (const bool spot : {true, false}) {
    const LightModel light = spot ? spotIn({0.0, 6.5, 0.0}) : sun();
    const BoundsFit fit{.boundsW = kBounds, .side = 256, .camera = &camera, .zNear = kNear, .snap = false};
    const BoundsFit wholeFit{.boundsW = kBounds, .side = 256, .zNear = kNear, .snap = false};
    const FittedMap fitted = spot ? makeSpotMap(light, fit) : makeDirectionalMap(light, fit);
    const FittedMap whole = spot ? makeSpotMap(light, wholeFit) : makeDirectionalMap(light, wholeFit);
    EXPECT_GT(scaleOf(fitted), 1.5 * scaleOf(whole));
    size_t seen = 0, casters = 0;
    for (const glm::dvec3& point : pointsIn(kBounds)) {
      if (spot && (!inCone(light, point) || glm::dot(point - light.positionW, light.directionW) < 1.001 * kNear))
        continue;
      const Place place = placeOf(fitted, point);
      if (seenBy(camera, point)) {
        ASSERT_TRUE(place.covered);
        ASSERT_LE(place.depth, 1.0);
        ++seen;
      }
      if (!place.covered) continue;
      ASSERT_GE(place.depth, 0.0) << "a caster before the near end would be clipped";
      ++casters;
    }
    EXPECT_GT(seen, size_t{100});
    EXPECT_GT(casters, seen);
  }
}

// What is fitted to the scene itself lies within what is fitted to its bounds.
TEST(BoundsFit, ASceneFitsIntoItsBounds) {
  const Scene scene = findGeneratedScene("contact")->make();
  const LightModel light = sun();
  const CameraView camera = cameraView(scene.cameras.front(), 64, 64);
  MapOptions options;
  options.set(kWindowFit(WindowFit::None));
  options.set(kSnap(false));
  const FittedMap fitted = directionalParameterization().fit(
      {.scene = scene, .light = light, .receiversW = {}, .side = 128, .camera = camera, .options = options});
  const FittedMap bounds = makeDirectionalMap(light, {.boundsW = computeBounds(scene), .side = 128, .snap = false});
  EXPECT_LE(bounds.zNear, fitted.zNear);
  EXPECT_GE(bounds.zFar, fitted.zFar);
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(bounds.map.mapSlices[0].clipFromLight[i][i] / fitted.map.mapSlices[0].clipFromLight[i][i], 1.0, 1e-3);
}

}  // namespace
}  // namespace gnomon
