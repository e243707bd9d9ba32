#include "shot.h"

#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace gnomon::test {

glsl::CameraView viewFrom(glm::dvec3 eyeW, glm::dvec3 targetW, double yFovRad, int width, int height) {
  const Camera camera = lookAt("test", glm::vec3(eyeW), glm::vec3(targetW), static_cast<float>(yFovRad));
  glsl::CameraView view{};
  view.eyeW = glm::vec3(camera.worldFromEye[3]);
  view.rightW = glm::vec3(camera.worldFromEye[0]);
  view.upW = glm::vec3(camera.worldFromEye[1]);
  view.forwardW = -glm::vec3(camera.worldFromEye[2]);
  view.tanHalfY = static_cast<float>(std::tan(0.5 * yFovRad));
  view.tanHalfX = view.tanHalfY * static_cast<float>(width) / static_cast<float>(height);
  view.width = width;
  view.height = height;
  return view;
}

glm::dvec3 pixelDirectionD(const glsl::CameraView& camera, int x, int y) {
  const double sx = (2.0 * (x + 0.5) / camera.width - 1.0) * static_cast<double>(camera.tanHalfX);
  const double sy = (1.0 - 2.0 * (y + 0.5) / camera.height) * static_cast<double>(camera.tanHalfY);
  return glm::dvec3(camera.forwardW) + glm::dvec3(camera.rightW) * sx + glm::dvec3(camera.upW) * sy;
}

std::vector<glsl::PrimitiveId> traceIds(const Tracer& tracer, const glsl::CameraView& camera) {
  std::vector<glsl::PrimitiveId> ids(static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height));
  tbb::parallel_for(0, camera.height, [&](int y) {
    for (int x = 0; x < camera.width; ++x) {
      const RayD ray{glm::dvec3(camera.eyeW), glm::normalize(pixelDirectionD(camera, x, y))};
      const std::optional<SurfaceHit> hit = tracer.firstHit(ray);
      glsl::PrimitiveId& id = ids[static_cast<size_t>(y) * static_cast<size_t>(camera.width) + static_cast<size_t>(x)];
      if (hit) id = {hit->primitive.instance + 1, hit->primitive.triangle};
    }
  });
  return ids;
}

Shot takeShot(Scene scene, const glsl::CameraView& camera, const LightModel& light) {
  Shot shot;
  shot.scene = std::make_unique<Scene>(std::move(scene));
  shot.tracer = std::make_unique<Tracer>(*shot.scene);
  shot.camera = camera;
  shot.light = light;
  shot.receivers = computeReceivers(*shot.tracer, camera, light, traceIds(*shot.tracer, camera));
  shot.truth = computeTruth(*shot.tracer, light, shot.receivers);
  return shot;
}

LabelImage labelShot(const Shot& shot, const ReferenceMap& map, int method, const glsl::BiasParams& params) {
  return labelPixels(*shot.tracer, shot.light, shot.receivers, shot.truth, predict(map, shot.receivers, method, params),
                     [&](size_t pixel) { return map.texelRay(shot.receivers.samples[pixel].positionW); });
}

LightModel pointLight(glm::dvec3 positionW) {
  LightModel light;
  light.positionW = positionW;
  return light;
}

LightModel directionalLight(glm::dvec3 directionW) {
  LightModel light;
  light.type = LightType::Directional;
  light.directionW = glm::normalize(directionW);
  return light;
}

std::string showCounts(const LabelImage& image) {
  std::string text;
  for (int i = 0; i < kLabelCount; ++i) {
    const auto label = static_cast<Label>(i);
    text += fmt::format("{} {}  ", labelName(label), image.count(label));
  }
  return text;
}

}  // namespace gnomon::test
