#include "truth/receivers.h"

#include "truth/triangle.h"

#include "base/check.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

double acrossOf(const glsl::CameraView& camera, int x) {
  return (2.0 * (x + 0.5) / camera.width - 1.0) * static_cast<double>(camera.tanHalfX);
}

double upOf(const glsl::CameraView& camera, int y) {
  return (1.0 - 2.0 * (y + 0.5) / camera.height) * static_cast<double>(camera.tanHalfY);
}

// Metres from a plane to the light, positive on the normal's side; of a directional light, only the sign means much.
double sideOfLight(const LightModel& light, const glm::dvec3& pointW, const glm::dvec3& normalW) {
  if (light.type == LightType::Directional) return -glm::dot(normalW, light.directionW);
  return glm::dot(normalW, light.positionW - pointW);
}

// What all pixels that see one triangle have in common.
struct SeenTriangle {
  Primitive primitive;
  Triangle triangle;
  glm::dvec3 normalW;  // unit, turned to the eye's side
  bool edgeOn;         // to the eye

  SeenTriangle(const Primitive& seen, const glm::dvec3 corners[3], const glm::dvec3& eyeW)
      : primitive(seen), triangle(corners), normalW(triangle.normal()) {
    const double eyeSide = glm::dot(normalW, eyeW - corners[0]);
    edgeOn = eyeSide == 0.0;
    if (eyeSide < 0.0) normalW = -normalW;
  }
  // But for a spot light's cone.
  PixelState stateFor(const LightModel& light) const {
    const bool away = edgeOn || !(sideOfLight(light, triangle.corners[0], normalW) > 0.0);
    return away ? PixelState::FacingAway : PixelState::Scored;
  }
};

// Calls `at(pixel, x, seen, isNew)` for each pixel of a row that sees a surface, and `empty(pixel)` for the others.
template <typename At, typename Empty>
void forRow(const Tracer& tracer, const glsl::CameraView& camera, std::span<const glsl::PrimitiveId> ids, int y,
            const At& at, const Empty& empty) {
  const glm::dvec3 eyeW(camera.eyeW);
  std::optional<SeenTriangle> seen;
  for (int x = 0; x < camera.width; ++x) {
    const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(camera.width) + static_cast<size_t>(x);
    if (ids[pixel].instancePlusOne == 0) {
      empty(pixel);
      continue;
    }
    const Primitive primitive{ids[pixel].instancePlusOne - 1, ids[pixel].triangle};
    const bool isNew = !seen || !(seen->primitive == primitive);
    if (isNew) {
      glm::dvec3 corners[3];
      tracer.corners(primitive, corners);
      seen.emplace(primitive, corners, eyeW);
    }
    at(pixel, x, *seen, isNew);
  }
}

bool isInCone(const LightModel& light, double cosOuterCone, const glm::dvec3& pointW) {
  return !(glm::dot(glm::normalize(pointW - light.positionW), light.directionW) < cosOuterCone);
}

// pixelRay's directions before they are made unit: what a column and a row bring.
struct PixelDirections {
  std::vector<glm::dvec3> columns;
  std::vector<glm::dvec3> rows;

  explicit PixelDirections(const glsl::CameraView& camera) {
    for (int x = 0; x < camera.width; ++x)
      columns.push_back(glm::dvec3(camera.forwardW) + glm::dvec3(camera.rightW) * acrossOf(camera, x));
    for (int y = 0; y < camera.height; ++y) rows.push_back(glm::dvec3(camera.upW) * upOf(camera, y));
  }
  RayD ray(const glm::dvec3& eyeW, int x, int y) const {
    return {eyeW, glm::normalize(columns[static_cast<size_t>(x)] + rows[static_cast<size_t>(y)])};
  }
};

}  // namespace

RayD pixelRay(const glsl::CameraView& camera, int x, int y) {
  const glm::dvec3 dir = glm::dvec3(camera.forwardW) + glm::dvec3(camera.rightW) * acrossOf(camera, x) +
                         glm::dvec3(camera.upW) * upOf(camera, y);
  return {glm::dvec3(camera.eyeW), glm::normalize(dir)};
}

SurfaceSamples computeSurfaces(const Tracer& tracer, const glsl::CameraView& camera,
                               std::span<const glsl::PrimitiveId> ids) {
  const size_t pixelCount = static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
  GNOMON_CHECK_EQ(ids.size(), pixelCount);
  PerPixel<SurfaceSample> samples(pixelCount);
  const glm::dvec3 eyeW(camera.eyeW);
  const PixelDirections directions(camera);
  tbb::parallel_for(0, camera.height, [&](int y) {
    forRow(
        tracer, camera, ids, y,
        [&](size_t pixel, int x, const SeenTriangle& seen, bool) {
          const TriangleMeeting meeting = seen.triangle.meet(directions.ray(eyeW, x, y));
          SurfaceSample& sample = samples[pixel];
          sample.positionW = meeting.edgeOn ? seen.triangle.corners[0] : meeting.positionW;
          sample.normalW = seen.normalW;
          sample.primitive = seen.primitive;
        },
        [&](size_t pixel) { samples[pixel] = {}; });
  });
  return SurfaceSamples(std::move(samples));
}

Receivers computeReceivers(const Tracer& tracer, const glsl::CameraView& camera, const LightModel& light,
                           std::span<const glsl::PrimitiveId> ids, const SurfaceSamples& surfaces) {
  GNOMON_CHECK_EQ(ids.size(), surfaces.size());
  Receivers receivers{.width = camera.width, .height = camera.height, .states = {}, .samples = surfaces};
  receivers.states.resize(surfaces.size());
  const double cosOuterCone = std::cos(light.outerConeRad);
  tbb::parallel_for(0, camera.height, [&](int y) {
    PixelState state = PixelState::Empty;  // of the triangle that is seen
    forRow(
        tracer, camera, ids, y,
        [&](size_t pixel, int, const SeenTriangle& seen, bool isNew) {
          if (isNew) state = seen.stateFor(light);
          const bool outside = state == PixelState::Scored && light.type == LightType::Spot &&
                               !isInCone(light, cosOuterCone, surfaces[pixel].positionW);
          receivers.states[pixel] = outside ? PixelState::OutsideCone : state;
        },
        [](size_t) {});
  });
  const auto count = [&](PixelState state) {
    return static_cast<size_t>(std::count(receivers.states.begin(), receivers.states.end(), state));
  };
  receivers.scored = count(PixelState::Scored);
  receivers.facingAway = count(PixelState::FacingAway);
  receivers.outsideCone = count(PixelState::OutsideCone);
  return receivers;
}

Receivers computeReceivers(const Tracer& tracer, const glsl::CameraView& camera, const LightModel& light,
                           std::span<const glsl::PrimitiveId> ids) {
  return computeReceivers(tracer, camera, light, ids, computeSurfaces(tracer, camera, ids));
}

}  // namespace gnomon
