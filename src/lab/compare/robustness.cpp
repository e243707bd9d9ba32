#include "lab/compare/robustness.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {

namespace {

// What the picture's centre shows, or where it shows nothing the nearest pixel that shows something.
glm::dvec3 shownAtCenter(const SceneView& seen) {
  const glsl::CameraView& view = seen.view();
  const Receivers receivers = computeReceivers(seen.tracer(), view, LightModel{}, seen.primitiveIds());
  glm::dvec3 target = glm::dvec3(computeBounds(seen.scene()).center());
  double least = 1e30;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const size_t i = static_cast<size_t>(y) * view.width + x;
      const double off = std::hypot(x - 0.5 * view.width, y - 0.5 * view.height);
      if (receivers.states[i] == PixelState::Empty || off >= least) continue;
      least = off;
      target = receivers.samples[i].positionW;
    }
  }
  return target;
}

}  // namespace

Camera orbitedCamera(const SceneView& view) {
  const glm::dvec3 target = shownAtCenter(view);
  const glm::dvec3 eye(view.view().eyeW);
  const double angle = glm::radians(kOrbitDegrees);
  const glm::dvec3 arm = eye - target;
  const glm::dvec3 turned(std::cos(angle) * arm.x + std::sin(angle) * arm.z, arm.y,
                          std::cos(angle) * arm.z - std::sin(angle) * arm.x);
  const double length = glm::length(turned);
  const glm::dvec3 dir = turned / length;
  // From a little before the target, which lies on a surface.
  const double start = 1e-3 * length;
  const std::optional<SurfaceHit> wall = view.tracer().firstHit({.origin = target + dir * start, .dir = dir});
  const double room = wall ? std::min(length, 0.9 * wall->distance) : length;
  return lookAt(fmt::format("{} degrees round", kOrbitDegrees), glm::vec3(target + dir * room), glm::vec3(target),
                view.camera().yFovRad);
}

// Another picture or another map of it, with a search's memory.
struct Robustness::Place {
  LightOnMap lit;
  TuningEvaluator evaluator;

  explicit Place(LightOnMap l) : lit(std::move(l)), evaluator(lit) {}
};

Robustness::Robustness(const LightOnMap& tuned, const CompareOptions& options)
    : otherView_(tuned.view(), orbitedCamera(tuned.view())) {
  const MapSetup setup = mapSetupOf(options, tuned.parameterization());
  LightOnMap other(otherView_, tuned.passes(), tuned.parameterization(), tuned.source(), tuned.light(), setup);
  if (other.receivers().scored > 0) otherCamera_ = std::make_unique<Place>(std::move(other));
  MapSetup halved = setup;
  halved.side = std::max(setup.side / 2, 2);
  halved.options = tuned.parameterization().halved(setup.options);
  otherMapSize_ = std::make_unique<Place>(LightOnMap(tuned, halved));
}

Robustness::~Robustness() = default;

Transfer Robustness::judgeAt(Place& place, const TunedMethod& tuned) {
  Transfer transfer;
  const double scored = place.evaluator.scored();
  const size_t errors = place.evaluator.biasErrors(tuned.method);
  const TunedMethod best = tune(place.evaluator, tuned.method);
  transfer.biasError = static_cast<double>(errors) / scored;
  transfer.bestBiasError = static_cast<double>(std::min(best.biasErrors, errors)) / scored;
  const Method& better = (best.biasErrors <= errors ? best : tuned).method;
  transfer.bestValue = valueOf(better.params, *better.bias, knobsOf(*better.bias).front());
  return transfer;
}

Tuning tuningOf(const TunedMethod& tuned) {
  const Knob& knob = knobsOf(*tuned.method.bias).front();
  Tuning tuning;
  tuning.knob = knob.name;
  tuning.value = valueOf(tuned.method.params, *tuned.method.bias, knob);
  tuning.unit = unitName(knob.unit);
  tuning.evaluations = tuned.evaluations;
  return tuning;
}

Tuning Robustness::judge(const TunedMethod& tuned) {
  Tuning tuning = tuningOf(tuned);
  if (otherCamera_) tuning.otherCamera = {judgeAt(*otherCamera_, tuned), otherView_.camera().name};
  tuning.otherMapSize = {judgeAt(*otherMapSize_, tuned), otherMapSize_->lit.fitted().map.width};
  return tuning;
}

}  // namespace gnomon
