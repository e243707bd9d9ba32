#include "lab/compare/robustness.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {

namespace {

// What the picture's centre shows, or where it shows nothing the nearest pixel that shows something.
glm::dvec3 shownAtCenter(const Session& session) {
  const glsl::CameraView& view = session.view();
  const Receivers receivers = computeReceivers(session.tracer(), view, LightModel{}, session.primitiveIds());
  glm::dvec3 target = glm::dvec3(computeBounds(session.scene()).center());
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

Camera orbitedCamera(const Session& session) {
  const glm::dvec3 target = shownAtCenter(session);
  const glm::dvec3 eye(session.view().eyeW);
  const double angle = glm::radians(kOrbitDegrees);
  const glm::dvec3 arm = eye - target;
  const glm::dvec3 turned(std::cos(angle) * arm.x + std::sin(angle) * arm.z, arm.y,
                          std::cos(angle) * arm.z - std::sin(angle) * arm.x);
  const double length = glm::length(turned);
  const glm::dvec3 dir = turned / length;
  // From a little before the target, which lies on a surface.
  const double start = 1e-3 * length;
  const std::optional<SurfaceHit> wall = session.tracer().firstHit({.origin = target + dir * start, .dir = dir});
  const double room = wall ? std::min(length, 0.9 * wall->distance) : length;
  return lookAt(fmt::format("{} degrees round", kOrbitDegrees), glm::vec3(target + dir * room), glm::vec3(target),
                session.camera().yFovRad);
}

// A picture and a map of it, with a search's memory.
struct Robustness::Place {
  const Session& session;
  Passes passes;
  Exact exact;
  std::unique_ptr<MapSet> maps;
  std::unique_ptr<Trial> trial;

  Place(const Session& s, Exact e, const CompareOptions& options, const Parameterization& parameterization, int side,
        const MapOptions& mapOptions)
      : session(s), passes(s.device(), s.view()), exact(std::move(e)) {
    const Fit fit = fitMap(s, parameterization, exact, side, mapOptions);
    maps = std::make_unique<MapSet>(s, passes.renderers, fit.fitted, exact, options.cull);
    trial = std::make_unique<Trial>(s, passes, exact, *maps);
  }
};

Robustness::Robustness(const Session& session, const Exact& exact, const CompareOptions& options,
                       const Parameterization& parameterization) {
  const int side = mapSideOf(options, parameterization);
  otherSession_ = std::make_unique<Session>(session, orbitedCamera(session));
  Exact other = traceExact(*otherSession_, exact.source, exact.light);
  if (other.receivers.scored > 0)
    otherCamera_ =
        std::make_unique<Place>(*otherSession_, std::move(other), options, parameterization, side, options.mapOptions);
  const MapOptions halved = parameterization.halved(options.mapOptions);
  otherMapSize_ = std::make_unique<Place>(session, exact, options, parameterization, std::max(side / 2, 2), halved);
}

Robustness::~Robustness() = default;

Elsewhere Robustness::judgeAt(Place& place, const TunedMethod& tuned) {
  Elsewhere elsewhere;
  const double scored = place.trial->scored();
  const size_t errors = place.trial->biasErrors(tuned.method);
  const TunedMethod best = tune(*place.trial, tuned.method);
  elsewhere.biasError = static_cast<double>(errors) / scored;
  elsewhere.bestBiasError = static_cast<double>(std::min(best.biasErrors, errors)) / scored;
  const BiasKnob& knob = knobsOf(*tuned.method.bias).front();
  elsewhere.bestValue = static_cast<double>((best.biasErrors <= errors ? best : tuned).method.params.*knob.field);
  return elsewhere;
}

Tuning tuningOf(const TunedMethod& tuned) {
  const BiasKnob& knob = knobsOf(*tuned.method.bias).front();
  Tuning tuning;
  tuning.knob = knob.name;
  tuning.value = static_cast<double>(tuned.method.params.*knob.field);
  tuning.unit = unitName(knob.unit);
  tuning.evaluations = tuned.evaluations;
  return tuning;
}

Tuning Robustness::judge(const TunedMethod& tuned) {
  Tuning tuning = tuningOf(tuned);
  if (otherCamera_) tuning.otherCamera = judgeAt(*otherCamera_, tuned);
  tuning.otherCameraName = otherSession_->camera().name;
  tuning.otherMapSize = judgeAt(*otherMapSize_, tuned);
  tuning.otherMapSide = otherMapSize_->maps->fitted().map.side;
  return tuning;
}

}  // namespace gnomon
