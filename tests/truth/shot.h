#pragma once
// A scene seen by a camera and lit by a light, up to the truth: what most tests start from.

#include "reference_map.h"

#include <memory>

namespace gnomon::test {

glsl::CameraView viewFrom(glm::dvec3 eyeW, glm::dvec3 targetW, double yFovRad, int width, int height);

// Direction (not unit) of a pixel's ray, in double from the view's floats.
glm::dvec3 pixelDirectionD(const glsl::CameraView& camera, int x, int y);

// What the camera sees, traced: the G-buffer without a GPU.
std::vector<glsl::PrimitiveId> traceIds(const Tracer& tracer, const glsl::CameraView& camera);

struct Shot {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<Tracer> tracer;
  glsl::CameraView camera{};
  LightModel light;
  Receivers receivers;
  Truth truth;
};
Shot takeShot(Scene scene, const glsl::CameraView& camera, const LightModel& light);

LabelImage labelShot(const Shot& shot, const ReferenceMap& map, int method, const glsl::BiasParams& params);

LightModel pointLight(glm::dvec3 positionW);
LightModel directionalLight(glm::dvec3 directionW);

// "agree 12 acne 3 ...", for failure messages.
std::string showCounts(const LabelImage& image);

}  // namespace gnomon::test
