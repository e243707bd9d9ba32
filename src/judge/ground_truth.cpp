#include "judge/ground_truth.h"

#include <algorithm>
#include <chrono>

namespace gnomon {

namespace {

// Directions and not points, so that what is near does not outweigh what is far.
glm::dvec3 aimOf(const SceneView& view, const Light& source) {
  const LightModel point{.type = LightType::Point, .positionW = glm::dvec3(source.positionW)};
  const std::shared_ptr<const GroundTruth> traced = view.groundTruths().of(view, source, point);
  const Receivers& receivers = traced->receivers;
  const Truth& truth = traced->truth;
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
  traced.receivers = computeReceivers(view.tracer(), view.view(), light, view.primitiveIds(), view.surfaces());
  traced.truth = computeTruth(view.tracer(), light, traced.receivers);
  traced.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return traced;
}

std::shared_ptr<const GroundTruth> GroundTruths::of(const SceneView& view, const Light& source,
                                                    const LightModel& light) {
  // Without the surfaces, which all have in common, a ground truth is two bytes a pixel.
  constexpr size_t kKeptBytes = 256u << 20;
  const size_t most = std::max<size_t>(kKeptBytes / (2 * std::max<size_t>(view.primitiveIds().size(), 1)), 1);
  const auto found = std::ranges::find_if(kept_, [&](const std::shared_ptr<const GroundTruth>& known) {
    return known->source.name == source.name && known->light == light;
  });
  if (found != kept_.end()) {
    std::rotate(kept_.begin(), found, found + 1);
  } else {
    kept_.insert(kept_.begin(), std::make_shared<const GroundTruth>(traceGroundTruth(view, source, light)));
    ++tracedCount_;
  }
  if (kept_.size() > most) kept_.resize(most);
  return kept_.front();
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
