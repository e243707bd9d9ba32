#include "lab/compare/tune.h"

#include "base/interrupt.h"
#include "judge/filtered_truth.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace gnomon {

namespace {

// The bracket shrinks to 0.618^8 = 2% of its logarithm: within 5% of the value, for the grid of a metres knob.
constexpr int kGoldenSteps = 8;
constexpr double kGolden = 0.6180339887498949;

// Evaluations of one knob, by its value; everything else stays.
class KnobSearch {
 public:
  KnobSearch(TuningEvaluator& evaluator, const Method& method, const Knob& knob, float sceneScale)
      : evaluator_(evaluator), method_(method), knob_(knob), unit_(knob.defaultOfSceneScale ? sceneScale : 1.0f) {}

  Method best() {
    std::vector<float> values = {knob_.lower, valueOf(method_.params, *method_.bias, knob_)};
    for (int i = 0; i < kTuneGrid; ++i) values.push_back(gridValue(i));
    std::vector<Method> methods;
    for (const float value : values) methods.push_back(with(value));
    evaluator_.expect(methods);
    for (const float value : values) errors(value);
    std::vector<std::pair<float, double>> points(seen_.begin(), seen_.end());
    const auto [first, last] = bestRun(points);
    float value = points[(first + last) / 2].first;
    const bool isPerfect = points[first].second == 0.0, isAnything = first == 0 && last + 1 == points.size();
    atEnd_ = isPerfect || isAnything ? "" : first == 0 ? "lower" : last + 1 == points.size() ? "upper" : "";
    if (first == last && first > 0 && first + 1 < points.size())
      value = golden(points[first - 1].first, value, points[first + 1].first);
    return with(value);
  }
  const char* atEnd() const { return atEnd_; }  // TunedMethod::atEnd, once best() is found

 private:
  float gridValue(int i) const {
    const double t = static_cast<double>(i) / (kTuneGrid - 1);
    const double share = knob_.searchLower * std::pow(knob_.searchUpper / knob_.searchLower, t);
    return std::clamp(static_cast<float>(share * unit_), knob_.lower, knob_.upper);
  }

  Method with(float value) const {
    Method changed = method_;
    valueOf(changed.params, *changed.bias, knob_) = value;
    return changed;
  }

  double errors(float value) {
    const auto found = seen_.find(value);
    if (found != seen_.end()) return found->second;
    return seen_.emplace(value, evaluator_.error(with(value))).first->second;
  }

  // The longest run of neighbouring points with the least error.
  static std::pair<size_t, size_t> bestRun(const std::vector<std::pair<float, double>>& points) {
    const double least = std::ranges::min_element(points, {}, [](const auto& p) { return p.second; })->second;
    std::pair<size_t, size_t> best{0, 0};
    bool found = false;
    for (size_t i = 0; i < points.size(); ++i) {
      if (points[i].second != least) continue;
      size_t last = i;
      while (last + 1 < points.size() && points[last + 1].second == least) ++last;
      if (!found || last - i > best.second - best.first) best = {i, last};
      found = true;
      i = last;
    }
    return best;
  }

  // A count steps, so golden section may end beside the best value it has seen: that one is returned.
  float golden(float lower, float value, float upper) {
    double a = std::log(std::max(lower, 1e-3f * value));
    double b = std::log(upper);
    double x = b - kGolden * (b - a);
    double y = a + kGolden * (b - a);
    float best = value;
    const auto at = [&](double logarithm) {
      const auto v = static_cast<float>(std::exp(logarithm));
      if (errors(v) < errors(best)) best = v;
      return errors(v);
    };
    for (int step = 0; step < kGoldenSteps; ++step) {
      if (at(x) <= at(y)) {
        b = y;
        y = x;
        x = b - kGolden * (b - a);
      } else {
        a = x;
        x = y;
        y = a + kGolden * (b - a);
      }
    }
    return best;
  }

  TuningEvaluator& evaluator_;
  Method method_;
  const Knob& knob_;
  float unit_;
  const char* atEnd_ = "";
  std::map<float, double> seen_;
};

}  // namespace

void TuningEvaluator::expect(std::vector<Method> methods) {
  if (!isFiltered()) lit_.expect(std::move(methods));
}

double TuningEvaluator::error(const Method& method) {
  throwIfInterrupted();
  return isFiltered() ? rmse(method) : static_cast<double>(biasErrors(method));
}

double TuningEvaluator::rmse(const Method& method) {
  ++evaluations_;
  const Receivers& receivers = lit_.receivers();
  if (filteredTruth_.empty()) {
    filteredTruth_ = lit_.filteredTruth(filter_);
    const auto diagnosis = lit_.diagnose(method);
    for (size_t i = 0; i < diagnosis.size(); ++i)
      if (receivers.states[i] == PixelState::Scored && verdictOf(diagnosis[i]) == Verdict::NotAsked)
        edgeOn_.push_back(i);
  }
  std::vector<float> visibility = lit_.visibility(method, filter_);
  for (const size_t pixel : edgeOn_) visibility[pixel] = filteredTruth_[pixel];
  return scoredRmse(receivers, visibility, filteredTruth_);
}

size_t TuningEvaluator::biasErrors(const Method& method) {
  ++evaluations_;
  const auto diagnosis = lit_.diagnose(method);
  const Receivers& receivers = lit_.receivers();
  const Truth& truth = lit_.truth();
  const FittedMap& map = lit_.fitted();
  wronglyShadowed_.resize(diagnosis.size());
  wronglyLit_.resize(diagnosis.size());
  const auto known = [&](size_t i) -> Known& { return truth.lit[i] == 0 ? wronglyLit_[i] : wronglyShadowed_[i]; };

  // Pixels that are known already, or right, are said to be right.
  std::vector<Verdict> unknown(diagnosis.size(), Verdict::NotAsked);
  std::vector<size_t> wrong;
  for (size_t i = 0; i < diagnosis.size(); ++i) {
    if (receivers.states[i] != PixelState::Scored) continue;
    const Verdict right = truth.lit[i] != 0 ? Verdict::Lit : Verdict::Shadow;
    const Verdict verdict = verdictOf(diagnosis[i]);
    unknown[i] = right;
    if (verdict == right || verdict == Verdict::NotAsked || verdict == Verdict::Uncovered) continue;
    wrong.push_back(i);
    if (known(i).label == Label::NotScored || known(i).texel != diagnosis[i].texel) unknown[i] = verdict;
  }
  const LabelImage labels = labelPixels(lit_.view().tracer(), lit_.light(), receivers, truth, unknown,
                                        [&](size_t pixel) { return texelRayW(map, diagnosis[pixel].texel); });
  size_t errors = 0;
  for (const size_t i : wrong) {
    if (labels.labels[i] != Label::Agree) known(i) = {diagnosis[i].texel, labels.labels[i]};
    const Label label = known(i).label;
    errors += label == Label::Acne || label == Label::Leak ? 1 : 0;
  }
  return errors;
}

TunedMethod tune(TuningEvaluator& evaluator, const Method& start) {
  TunedMethod tuned{.method = start};
  const int before = evaluator.evaluations();
  const std::vector<Knob>& knobs = knobsOf(*start.bias);
  const int rounds = knobs.size() > 1 ? 2 : 1;
  for (int round = 0; round < rounds; ++round)
    for (const Knob& knob : knobs) {
      KnobSearch search(evaluator, tuned.method, knob, evaluator.sceneScale());
      tuned.method = search.best();
      if (&knob == &knobs.front()) tuned.atEnd = search.atEnd();
    }
  tuned.error = evaluator.error(tuned.method);
  tuned.evaluations = evaluator.evaluations() - before;
  return tuned;
}

}  // namespace gnomon
