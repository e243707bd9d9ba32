// What a pixel sees, in double.

#include "scenes_by_hand.h"
#include "shot.h"

#include "truth/triangle.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::test {
namespace {

Scene roomScene() {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 10.0);
  addBox(scene, {-1, 0, -1}, {1, 1, 1});
  const int sphere = addSphere(scene, {2, 1.5, 0}, 0.7, 12, 20);
  const glm::mat4 mirrored =
      glm::translate(glm::mat4(1.0f), {1.0f, 0.5f, 3.0f}) * glm::scale(glm::mat4(1.0f), {-0.5f, 0.6f, 0.7f});
  addInstance(scene, scene.instances[static_cast<size_t>(sphere)].mesh, mirrored);
  return scene;
}

TEST(Receivers, LieOnTheirPixelsRayAndOnTheirTriangle) {
  const glsl::CameraView camera = viewFrom({4, 4, 6}, {0.5, 0.5, 0}, 0.9, 240, 160);
  const Shot shot = takeShot(roomScene(), camera, pointLight({0.3, 5.0, 0.2}));
  double offRay = 0.0, offPlane = 0.0;
  size_t seen = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const size_t pixel = static_cast<size_t>(y * camera.width + x);
      if (shot.receivers.states[pixel] == PixelState::Empty) continue;
      ++seen;
      const SurfaceSample& sample = shot.receivers.samples[pixel];
      const glm::dvec3 eye(camera.eyeW);
      const glm::dvec3 dir = glm::normalize(pixelDirectionD(camera, x, y));
      offRay =
          std::max(offRay, glm::length(glm::cross(sample.positionW - eye, dir)) / glm::length(sample.positionW - eye));
      glm::dvec3 at[3];
      shot.tracer->corners(sample.primitive, at);
      offPlane = std::max(offPlane, std::abs(glm::dot(sample.normalW, sample.positionW - at[0])));
      EXPECT_NEAR(glm::length(sample.normalW), 1.0, 1e-12);
      if (shot.receivers.states[pixel] == PixelState::Scored) {
        EXPECT_GT(glm::dot(sample.normalW, shot.light.positionW - sample.positionW), 0.0);
      }
    }
  }
  EXPECT_GT(seen, 20000u);
  EXPECT_LT(offRay, 1e-9);
  EXPECT_LT(offPlane, 1e-12);
}

TEST(Receivers, CountEveryPixelOnce) {
  LightModel light = pointLight({0.3, 5.0, 0.2});
  light.type = LightType::Spot;
  light.outerConeRad = 0.5;
  const Shot shot = takeShot(roomScene(), viewFrom({4, 4, 6}, {0.5, 0.5, 0}, 0.9, 240, 160), light);
  const Receivers& r = shot.receivers;
  const auto empty = static_cast<size_t>(std::count(r.states.begin(), r.states.end(), PixelState::Empty));
  EXPECT_EQ(r.scored + r.facingAway + r.outsideCone + empty, r.states.size());
  EXPECT_GT(r.scored, 0u);
  EXPECT_GT(r.facingAway, 0u);
  EXPECT_GT(r.outsideCone, 0u);
  for (size_t i = 0; i < r.states.size(); ++i) {
    if (r.states[i] != PixelState::Scored && r.states[i] != PixelState::OutsideCone) continue;
    const glm::dvec3 to = glm::normalize(r.samples[i].positionW - light.positionW);
    EXPECT_EQ(std::acos(glm::dot(to, light.directionW)) > 0.5, r.states[i] == PixelState::OutsideCone);
  }
}

// A light in a plane's own plane gives it nothing; on the camera's other side neither.
TEST(Receivers, FaceAwayFromALightInOrBehindTheirPlane) {
  const glsl::CameraView camera = viewFrom({0, 3, 0.1}, {0, 0, 0}, 0.5, 32, 32);
  for (const double height : {-1.0, 0.0, 1e-9}) {
    Scene scene = emptyScene();
    addFloor(scene, 0.0, 10.0);
    const Shot shot = takeShot(std::move(scene), camera, pointLight({20.0, height, 0.0}));
    EXPECT_EQ(shot.receivers.scored, height > 0.0 ? 1024u : 0u) << height;
  }
  // From below, where the plane's own normal looks away from the camera.
  Scene below = emptyScene();
  addFloor(below, 0.0, 10.0);
  const Shot inPlane =
      takeShot(std::move(below), viewFrom({0, -3, 0.1}, {0, 0, 0}, 0.5, 32, 32), pointLight({20, 0, 0}));
  EXPECT_EQ(inPlane.receivers.facingAway, 1024u);
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 10.0);
  const Shot level = takeShot(std::move(scene), camera, directionalLight({1, 0, 0}));
  EXPECT_EQ(level.receivers.facingAway, 1024u);
}

// A pixel whose centre the rasterizer gave to a triangle that the ray passes beside gets that triangle's nearest point.
TEST(Receivers, AreClampedToTheTriangleTheGBufferNames) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 0.5);
  const Tracer tracer(scene);
  const glsl::CameraView camera = viewFrom({0, 3, 0.1}, {0, 0, 0}, 1.5, 16, 16);
  const std::vector<glsl::PrimitiveId> ids(256, {1, 1});
  const Receivers receivers = computeReceivers(tracer, camera, pointLight({0, 2, 0}), ids);
  for (const SurfaceSample& sample : receivers.samples) {
    EXPECT_LE(std::abs(sample.positionW.x), 0.5 + 1e-12);
    EXPECT_LE(std::abs(sample.positionW.z), 0.5 + 1e-12);
    EXPECT_NEAR(sample.positionW.y, 0.0, 1e-12);
  }
}

// shared/geometry.glsl's point, as the shaders compute it in float: how far off the plane, and along it, it strays from
// the double one. Along the plane costs a fraction of a texel; off the plane is what a bias has to cover.
TEST(SurfacePoint, InFloatStaysWithinUlpsOfThePlane) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto point = [&](double scale) { return scale * glm::dvec3(unit(random), unit(random), unit(random)); };
  double offPlane = 0.0, aside = 0.0;
  for (int i = 0; i < 100000; ++i) {
    glm::vec3 cornersF[3];
    glm::dvec3 corners[3];
    for (int k = 0; k < 3; ++k) {
      cornersF[k] = glm::vec3(point(8.0));
      corners[k] = glm::dvec3(cornersF[k]);
    }
    const glm::vec3 eye(point(8.0));
    const double u = 0.5 + 0.5 * unit(random), v = (1.0 - u) * (0.5 + 0.5 * unit(random));
    const glm::dvec3 target = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
    const RayD ray{glm::dvec3(eye), glm::normalize(target - glm::dvec3(eye))};
    const glm::dvec3 normal = triangleNormal(corners);
    if (std::abs(glm::dot(normal, ray.dir)) < 0.05) continue;
    const TriangleMeeting meeting = meetTriangle(ray, corners);
    EXPECT_LT(glm::length(meeting.positionW - target), 1e-12);
    const glsl::SurfacePoint floats =
        glsl::surfacePoint({eye, glm::vec3(ray.dir)}, cornersF[0], cornersF[1], cornersF[2]);
    offPlane = std::max(offPlane, std::abs(glm::dot(normal, glm::dvec3(floats.position) - corners[0])));
    aside = std::max(aside, glm::length(glm::dvec3(floats.position) - target));
  }
  // An ulp of a coordinate below 8 is 4.8e-7. Off the plane: two roundings a corner and sum. Aside: the float
  // ray's error over the cosine of at least 0.05, and triangles as thin as chance makes them.
  EXPECT_LT(offPlane, 2.0e-6);
  EXPECT_LT(aside, 1e-2);
}

}  // namespace
}  // namespace gnomon::test
