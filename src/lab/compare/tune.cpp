#include "lab/compare/tune.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace gnomon {

namespace {

// The bracket shrinks to 0.618^8 = 2% of its logarithm: within 5% of the value, for the grid of a metres
// knob.
constexpr int kGoldenSteps = 8;
constexpr double kGolden = 0.6180339887498949;

// Evaluations of one knob, by its value; everything else stays.
class KnobSearch {
 public:
  KnobSearch(Trial& trial, const Method& method, const Knob& knob, float sceneScale)
      : trial_(trial), method_(method), knob_(knob), unit_(knob.defaultOfSceneScale ? sceneScale : 1.0f) {}

  Method best() {
    for (int i = 0; i < kTuneGrid; ++i) errors(gridValue(i));
    errors(knob_.lower);
    errors(valueOf(method_.params, *method_.bias, knob_));
    std::vector<std::pair<float, size_t>> points(seen_.begin(), seen_.end());
    const auto [first, last] = bestRun(points);
    float value = points[(first + last) / 2].first;
    if (first == last && first > 0 && first + 1 < points.size())
      value = golden(points[first - 1].first, value, points[first + 1].first);
    return with(value);
  }

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

  size_t errors(float value) {
    const auto found = seen_.find(value);
    if (found != seen_.end()) return found->second;
    return seen_.emplace(value, trial_.biasErrors(with(value))).first->second;
  }

  // The longest run of neighbouring points with the fewest errors.
  static std::pair<size_t, size_t> bestRun(const std::vector<std::pair<float, size_t>>& points) {
    const size_t least = std::ranges::min_element(points, {}, [](const auto& p) { return p.second; })->second;
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

  // The count steps, so golden section may end beside the best value it has seen: that one is returned.
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

  Trial& trial_;
  Method method_;
  const Knob& knob_;
  float unit_;
  std::map<float, size_t> seen_;
};

}  // namespace

size_t Trial::biasErrors(const Method& method) {
  ++evaluations_;
  const DrawnMap& map = maps_.with(method.bias->channels);
  const auto diagnosis = diagnose(session_, passes_, map, exact_, method);
  shadowed_.resize(diagnosis.size());
  lit_.resize(diagnosis.size());
  const auto wronglyLit = [&](size_t i) { return exact_.truth.lit[i] == 0; };
  const auto known = [&](size_t i) -> Known& { return wronglyLit(i) ? lit_[i] : shadowed_[i]; };

  // Pixels that are known already, or right, are said to be right.
  std::vector<Verdict> unknown(diagnosis.size(), Verdict::NotAsked);
  std::vector<size_t> wrong;
  for (size_t i = 0; i < diagnosis.size(); ++i) {
    if (exact_.receivers.states[i] != PixelState::Scored) continue;
    const Verdict right = exact_.truth.lit[i] != 0 ? Verdict::Lit : Verdict::Shadow;
    const Verdict verdict = verdictOf(diagnosis[i]);
    unknown[i] = right;
    if (verdict == right || verdict == Verdict::NotAsked || verdict == Verdict::Uncovered) continue;
    wrong.push_back(i);
    if (known(i).label == Label::NotScored || known(i).texel != diagnosis[i].texel) unknown[i] = verdict;
  }
  const LabelImage labels = labelPixels(session_.tracer(), exact_.light, exact_.receivers, exact_.truth, unknown,
                                        [&](size_t pixel) { return texelRayW(map.fitted, diagnosis[pixel].texel); });
  size_t errors = 0;
  for (const size_t i : wrong) {
    if (labels.labels[i] != Label::Agree) known(i) = {diagnosis[i].texel, labels.labels[i]};
    const Label label = known(i).label;
    errors += label == Label::Acne || label == Label::Leak ? 1 : 0;
  }
  return errors;
}

TunedMethod tune(Trial& trial, const Method& start) {
  TunedMethod tuned{.method = start};
  const int before = trial.evaluations();
  const std::vector<Knob>& knobs = knobsOf(*start.bias);
  const int rounds = knobs.size() > 1 ? 2 : 1;
  for (int round = 0; round < rounds; ++round)
    for (const Knob& knob : knobs) tuned.method = KnobSearch(trial, tuned.method, knob, trial.sceneScale()).best();
  tuned.biasErrors = trial.biasErrors(tuned.method);
  tuned.evaluations = trial.evaluations() - before;
  return tuned;
}

}  // namespace gnomon
