// Where a pixel's ray meets its triangle's plane (shared/plane_view.glsl), against the same in double.
#include "scene/gbuffer.h"

#include "shared/plane_view.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gnomon {
namespace {

constexpr int kSide = 1024;  // pixels

struct Shot {
  glsl::CameraView camera;
  glsl::LightFrame frame;
  glsl::EyeView eye;
  glm::vec3 axisL;
};

Shot shotFrom(glm::vec3 eyeW, glm::vec3 targetW, glm::vec3 lightW) {
  Shot shot{.camera = cameraView(lookAt("camera", eyeW, targetW, 1.0f), kSide, kSide),
            .frame = {lightW, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  shot.eye = glsl::eyeView(shot.camera, shot.frame);
  shot.axisL = glsl::directionFromWorld(shot.frame, shot.camera.forwardW);
  return shot;
}

TEST(PlaneView, APointLiesOnItsPlaneAndOnItsRay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> anywhere(-10.0f, 10.0f), pixel(0.0f, kSide);
  double worstOff = 0.0, worstAside = 0.0, worstOther = 0.0;
  int seen = 0;
  for (int i = 0; i < 1 << 16; ++i) {
    const auto point = [&] { return glm::vec3(anywhere(random), anywhere(random), anywhere(random)); };
    const Shot shot = shotFrom(point(), point(), point());
    const glm::vec2 at = glm::floor(glm::vec2(pixel(random), pixel(random))) + 0.5f;
    // A triangle around a point on the pixel's ray.
    const glm::vec3 dirW = glsl::pixelDirection(shot.camera, int(at.x), int(at.y));
    const glm::vec3 middle = shot.camera.eyeW + dirW * (6.0f + 0.5f * anywhere(random));
    const glm::vec3 u = 0.1f * point(), v = 0.1f * point();
    const glm::vec3 corners[3] = {middle + u + v, middle - u, middle - v};
    glm::vec3 cornersL[3];
    for (int k = 0; k < 3; ++k) cornersL[k] = glsl::lightFromWorld(shot.frame, corners[k]);
    const glsl::PlaneView plane = glsl::planeView(shot.eye, shot.axisL, cornersL[0], cornersL[1], cornersL[2]);
    const glm::dvec3 normal =
        glm::normalize(glm::cross(glm::dvec3(cornersL[1] - cornersL[0]), glm::dvec3(cornersL[2] - cornersL[0])));
    if (std::abs(glm::dot(normal, glm::normalize(glm::dvec3(dirW)))) < 0.02) continue;  // edge-on: the next test
    // A slender triangle's normal is off by as many ulps as it is slender, whatever is done with it.
    const double longest = std::max(glm::length(u + 2.0f * v), glm::length(2.0f * u + v));
    const double twiceArea =
        glm::length(glm::cross(glm::dvec3(cornersL[1] - cornersL[0]), glm::dvec3(cornersL[2] - cornersL[0])));
    if (longest * longest > 8.0 * twiceArea) continue;
    ++seen;
    const glm::vec3 dirL = glsl::eyeDirection(shot.eye, at);
    const glm::vec3 fromEye = dirL * glsl::planeDistance(plane, dirL);
    const glm::dvec3 posL(shot.eye.eyeL + fromEye);
    worstOff = std::max(worstOff, std::abs(glm::dot(normal, posL - glm::dvec3(cornersL[0]))));
    const glm::dvec3 ray = glm::normalize(glm::dvec3(dirW));
    const glm::dvec3 along = posL + glm::dvec3(shot.frame.originW) - glm::dvec3(shot.camera.eyeW);
    worstAside = std::max(worstAside, glm::length(along - ray * glm::dot(along, ray)));
    const glsl::SurfacePoint other =
        glsl::surfacePoint({shot.camera.eyeW, glsl::unitVector(dirW)}, corners[0], corners[1], corners[2]);
    worstOther =
        std::max(worstOther, std::abs(glm::dot(normal, glm::dvec3(glsl::lightFromWorld(shot.frame, other.position)) -
                                                           glm::dvec3(cornersL[0]))));
  }
  EXPECT_GT(seen, 30000);
  // Coordinates reach 30 m, whose ulp is 1.9e-6.
  const double ulp = std::ldexp(1.0, -19);
  EXPECT_LT(worstOff, 4.0 * ulp);
  EXPECT_LT(worstOther, 4.0 * ulp);  // no better
  EXPECT_LT(worstAside, 4.0 * ulp);
}

// A plane through the eye, a triangle without area: a number in any case, within the triangle's distances.
TEST(PlaneView, APlaneSeenEdgeOnGivesANumber) {
  const Shot shot = shotFrom({0, 0, 0}, {0, 0, -1}, {1, 2, 3});
  const glm::vec3 cases[][3] = {{{0, -1, -2}, {0, 1, -2}, {0, 0, -8}},  // in the plane x = 0, with the eye
                                {{1, 1, -3}, {1, 1, -3}, {1, 1, -3}},   // no area
                                {{-4, 0, -2}, {4, 1e-7f, -2}, {0, 0, -9}}};
  for (const auto& corners : cases) {
    glm::vec3 cornersL[3];
    for (int k = 0; k < 3; ++k) cornersL[k] = glsl::lightFromWorld(shot.frame, corners[k]);
    const glsl::PlaneView plane = glsl::planeView(shot.eye, shot.axisL, cornersL[0], cornersL[1], cornersL[2]);
    for (float x = 0.5f; x < kSide; x += 64.0f) {
      const float t = glsl::planeDistance(plane, glsl::eyeDirection(shot.eye, {x, 0.5f * kSide}));
      EXPECT_GE(t, 2.0f * 63.0f / 64.0f * 0.99999f);
      EXPECT_LE(t, 9.0f * 65.0f / 64.0f * 1.00001f);
    }
  }
}

}  // namespace
}  // namespace gnomon
