#include "lab/compare/robustness.h"

#include "base/interrupt.h"

#include <algorithm>
#include <cmath>
#include <map>

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

// Another picture or another map of it, with a search's memory for each filter.
struct Robustness::Place {
  LightOnMap lit;
  std::map<int, TuningEvaluator> evaluators;

  explicit Place(LightOnMap l) : lit(std::move(l)) {}
  TuningEvaluator& evaluator(const ChosenFilter& filter) {
    return evaluators.try_emplace(filter.id, lit, filter).first->second;
  }

  Transfer judge(const TunedMethod& tuned, const ChosenFilter& filter);
  ErrorCount count(const Method& method, const ChosenFilter& filter);
};

Robustness::Robustness(const LightOnMap& here, const CompareOptions& options)
    : otherView_(here.view(), orbitedCamera(here.view())) {
  const MapSetup setup = mapSetupOf(options, here.parameterization());
  LightOnMap other(otherView_, here.passes(), here.parameterization(), here.source(), here.light(), setup);
  if (other.receivers().scored > 0) otherCamera_ = std::make_unique<Place>(std::move(other));
  MapSetup halved = setup;
  halved.side = std::max(setup.side / 2, 2);
  halved.options = here.parameterization().halved(setup.options);
  otherMapSize_ = std::make_unique<Place>(LightOnMap(here, halved));
}

Robustness::~Robustness() = default;

Transfer Robustness::Place::judge(const TunedMethod& tuned, const ChosenFilter& filter) {
  TuningEvaluator& evaluator_ = evaluator(filter);
  const double error = evaluator_.error(tuned.method);
  const TunedMethod best = tune(evaluator_, tuned.method);
  const Method& better = (best.error <= error ? best : tuned).method;
  Transfer transfer;
  transfer.bestValue = valueOf(better.params, *better.bias, knobsOf(*better.bias).front());
  transfer.biasError = static_cast<double>(evaluator_.biasErrors(tuned.method)) / evaluator_.scored();
  transfer.bestBiasError = static_cast<double>(evaluator_.biasErrors(better)) / evaluator_.scored();
  if (!evaluator_.isFiltered()) return transfer;
  transfer.rmse = error;
  transfer.bestRmse = std::min(best.error, error);
  return transfer;
}

ErrorCount Robustness::Place::count(const Method& method, const ChosenFilter& filter) {
  const LabelledResult judged = lit.judge(method);
  ErrorCount count;
  count.scored = lit.receivers().scored;
  count.biasErrors = judged.labels.count(Label::Acne) + judged.labels.count(Label::Leak);
  count.wrong = count.scored - judged.labels.count(Label::Agree);
  if (filter.id == glsl::kShadowFilterNone) return count;
  const double rmse = evaluator(filter).rmse(method);
  count.squares = rmse * rmse * static_cast<double>(count.scored);
  return count;
}

ErrorCount& ErrorCount::operator+=(const ErrorCount& other) {
  scored += other.scored;
  biasErrors += other.biasErrors;
  wrong += other.wrong;
  if (other.squares) squares = squares.value_or(0.0) + *other.squares;
  return *this;
}

void ErrorCount::tell(ErrorElsewhere& there) const {
  const double all = static_cast<double>(scored);
  there.biasError = static_cast<double>(biasErrors) / all;
  there.allWrong = static_cast<double>(wrong) / all;
  if (squares) there.rmse = std::sqrt(*squares / all);
}

Tuning tuningOf(const TunedMethod& tuned) {
  const Knob& knob = knobsOf(*tuned.method.bias).front();
  Tuning tuning;
  tuning.knob = knob.name;
  tuning.value = valueOf(tuned.method.params, *tuned.method.bias, knob);
  tuning.unit = unitName(knob.unit);
  tuning.evaluations = tuned.evaluations;
  tuning.atEnd = tuned.atEnd;
  return tuning;
}

Tuning Robustness::judge(const TunedMethod& tuned, const ChosenFilter& filter) {
  Tuning tuning = tuningOf(tuned);
  if (otherCamera_) tuning.otherCamera = {otherCamera_->judge(tuned, filter), otherView_.camera().name};
  tuning.otherMapSize = {otherMapSize_->judge(tuned, filter), otherMapSize_->lit.fitted().map.width};
  return tuning;
}

Elsewhere Robustness::judge(const Method& method, const ChosenFilter& filter, Counts& counts) {
  Elsewhere elsewhere;
  if (otherCamera_) counts.otherCamera += otherCamera_->count(method, filter);
  if (counts.otherCamera.scored > 0) {
    counts.otherCamera.tell(elsewhere.otherCamera.emplace());
    elsewhere.otherCamera->camera = otherView_.camera().name;
  }
  counts.otherMapSize += otherMapSize_->count(method, filter);
  counts.otherMapSize.tell(elsewhere.otherMapSize.emplace());
  elsewhere.otherMapSize->mapSize = otherMapSize_->lit.fitted().map.width;
  return elsewhere;
}

Elsewhere Robustness::judge(const Method& method, const ChosenFilter& filter) {
  Counts counts;
  return judge(method, filter, counts);
}

namespace {

// How wrong a row's method is from another camera and on half the map, over all lights together.
Elsewhere elsewhereOf(const Session& session, ShadowPasses& passes, const CompareOptions& options, const Row& row) {
  const Parameterization& map = **std::ranges::find(options.maps, row.map, &Parameterization::name);
  const BiasMethod& bias = **std::ranges::find(options.biases, row.bias, &BiasMethod::name);
  const Filter& filter = **std::ranges::find(options.filters, row.filter, &Filter::name);
  Elsewhere elsewhere;
  Robustness::Counts counts;
  for (const Light& light : chooseLights(session.setup(), session.tracer(), map)) {
    throwIfInterrupted();
    const LightOnMap lit(session, passes, map, light, mapSetupOf(options, map));
    if (lit.receivers().scored == 0) continue;
    elsewhere = Robustness(lit, options).judge(methodFor(session, options, bias), filterFor(options, filter), counts);
  }
  return elsewhere;
}

}  // namespace

void measureRecommended(const Session& session, ShadowPasses& passes, const CompareOptions& options,
                        std::vector<Row>& rows) {
  if (options.maps.size() * options.biases.size() * options.filters.size() < 2) return;
  const std::vector<Row> inOrder = ranked(rows);
  const Row& best = *bestOf(inOrder).untuned;
  for (Row& row : rows)
    if (row.map == best.map && row.light == best.light && row.isSum == best.isSum && row.bias == best.bias &&
        row.filter == best.filter && !row.isTuned())
      row.elsewhere = elsewhereOf(session, passes, options, row);
}

}  // namespace gnomon
