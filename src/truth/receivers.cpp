#include "truth/receivers.h"

#include "truth/triangle.h"

#include "base/check.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

// Metres from a plane to the light, positive on the normal's side; of a directional light, only the sign means much.
double sideOfLight(const LightModel& light, const glm::dvec3& pointW, const glm::dvec3& normalW) {
  if (light.type == LightType::Directional) return -glm::dot(normalW, light.directionW);
  return glm::dot(normalW, light.positionW - pointW);
}

PixelState classify(const LightModel& light, const glm::dvec3& eyeW, const glm::dvec3& cornerW, SurfaceSample& sample) {
  const double eyeSide = glm::dot(sample.normalW, eyeW - cornerW);
  const double lightSide = sideOfLight(light, cornerW, sample.normalW);
  if (lightSide < 0.0) sample.normalW = -sample.normalW;
  if (eyeSide == 0.0 || lightSide == 0.0 || (eyeSide > 0.0) != (lightSide > 0.0)) return PixelState::FacingAway;
  if (light.type == LightType::Spot) {
    const glm::dvec3 toPoint = sample.positionW - light.positionW;
    const double cosine = glm::dot(glm::normalize(toPoint), light.directionW);
    if (cosine < std::cos(light.outerConeRad)) return PixelState::OutsideCone;
  }
  return PixelState::Scored;
}

}  // namespace

RayD pixelRay(const glsl::CameraView& camera, int x, int y) {
  const double sx = (2.0 * (x + 0.5) / camera.width - 1.0) * static_cast<double>(camera.tanHalfX);
  const double sy = (1.0 - 2.0 * (y + 0.5) / camera.height) * static_cast<double>(camera.tanHalfY);
  const glm::dvec3 dir = glm::dvec3(camera.forwardW) + glm::dvec3(camera.rightW) * sx + glm::dvec3(camera.upW) * sy;
  return {glm::dvec3(camera.eyeW), glm::normalize(dir)};
}

Receivers computeReceivers(const Tracer& tracer, const glsl::CameraView& camera, const LightModel& light,
                           std::span<const glsl::PrimitiveId> ids) {
  const size_t pixelCount = static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
  GNOMON_CHECK_EQ(ids.size(), pixelCount);
  Receivers receivers{.width = camera.width, .height = camera.height};
  receivers.states.assign(pixelCount, PixelState::Empty);
  receivers.samples.resize(pixelCount);
  tbb::parallel_for(0, camera.height, [&](int y) {
    for (int x = 0; x < camera.width; ++x) {
      const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(camera.width) + static_cast<size_t>(x);
      if (ids[pixel].instancePlusOne == 0) continue;
      SurfaceSample& sample = receivers.samples[pixel];
      sample.primitive = {ids[pixel].instancePlusOne - 1, ids[pixel].triangle};
      glm::dvec3 corners[3];
      tracer.corners(sample.primitive, corners);
      const RayD ray = pixelRay(camera, x, y);
      const TriangleMeeting meeting = meetTriangle(ray, corners);
      sample.positionW = meeting.edgeOn ? corners[0] : meeting.positionW;
      sample.normalW = triangleNormal(corners);
      receivers.states[pixel] = classify(light, ray.origin, corners[0], sample);
    }
  });
  const auto count = [&](PixelState state) {
    return static_cast<size_t>(std::count(receivers.states.begin(), receivers.states.end(), state));
  };
  receivers.scored = count(PixelState::Scored);
  receivers.facingAway = count(PixelState::FacingAway);
  receivers.outsideCone = count(PixelState::OutsideCone);
  return receivers;
}

}  // namespace gnomon
