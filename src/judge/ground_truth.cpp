#include "judge/ground_truth.h"

#include <chrono>

namespace gnomon {

namespace {

// Directions and not points, so that what is near does not outweigh what is far.
glm::dvec3 aimOf(const SceneView& view, const Light& source) {
  const LightModel point{.type = LightType::Point, .positionW = glm::dvec3(source.positionW)};
  const GroundTruth traced = traceGroundTruth(view, source, point);
  const Receivers& receivers = traced.receivers;
  const Truth& truth = traced.truth;
  glm::dvec3 sum(0.0);
  for (size_t i = 0; i < receivers.states.size(); ++i) {
    if (receivers.states[i] != PixelState::Scored || (truth.litCount > 0 && truth.lit[i] == 0)) continue;
    sum += glm::normalize(receivers.samples[i].positionW - point.positionW);
  }
  return glm::length(sum) > 0.0 ? glm::normalize(sum) : glm::dvec3(0, -1, 0);
}

}  // namespace

GroundTruth traceGroundTruth(const SceneView& view, const Light& source, const LightModel& light) {
  const auto start = std::chrono::steady_clock::now();
  GroundTruth traced{.source = source, .light = light, .receivers = {}, .truth = {}};
  traced.receivers = computeReceivers(view.tracer(), view.view(), light, view.primitiveIds());
  traced.truth = computeTruth(view.tracer(), light, traced.receivers);
  traced.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return traced;
}

const Light* firstLightFor(const Scene& scene, const Parameterization& map) {
  for (const auto wanted : {LightSupport::Yes, LightSupport::Fallback})
    for (const Light& light : scene.lights)
      if (map.supportsLight(light.type) == wanted) return &light;
  return nullptr;
}

LightModel lightTakenBy(const Parameterization& map, const SceneView& view, const Light& source) {
  return map.lightModel(source, map.needsAim(source.type) ? aimOf(view, source) : glm::dvec3(0.0));
}

}  // namespace gnomon
