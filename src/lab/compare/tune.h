#pragma once
// Tuning: the parameter values of a bias with the least error for one picture, so that biases with parameters are
// compared fairly: the least acne + leak, or through a filter the least RMSE. All evaluations share one map and one
// ground truth. Labels are cached: a pixel that is wrong in the same way, by the same texel, has the same label
// whatever the parameters.

#include "judge/light_on_map.h"

namespace gnomon {

// Evaluates a method's error again and again.
class TuningEvaluator {
 public:
  explicit TuningEvaluator(LightOnMap& lit, const ChosenFilter& filter = glsl::kShadowFilterNone)
      : lit_(lit), filter_(filter) {}

  bool isFiltered() const { return filter_.id != glsl::kShadowFilterNone; }
  // What error() will be asked for next: without a filter they are decided together (LightOnMap::expect).
  void expect(std::vector<Method> methods);
  // What the search minimizes: biasErrors, or rmse where there is a filter.
  double error(const Method& method);
  // Unfiltered pixels that the bias is answerable for: acne + leak.
  size_t biasErrors(const Method& method);
  // Against the ground truth through the same filter.
  double rmse(const Method& method);

  double scored() const { return static_cast<double>(lit_.receivers().scored); }
  float sceneScale() const { return lit_.fitted().map.sceneScale; }  // metres
  int evaluations() const { return evaluations_; }

 private:
  struct Known {  // of a wrong pixel
    uint32_t texel = 0;
    Label label = Label::NotScored;
  };

  LightOnMap& lit_;
  const ChosenFilter filter_;
  std::vector<Known> wronglyShadowed_, wronglyLit_;  // one a pixel
  std::vector<float> filteredTruth_;                 // when first needed
  std::vector<size_t> edgeOn_;                       // LabelledResult::edgeOn, which is the same for all methods
  int evaluations_ = 0;
};

struct TunedMethod {
  Method method;
  double error = 0.0;  // TuningEvaluator::error
  int evaluations = 0;
  const char* atEnd = "";  // of the first knob: "lower" or "upper" where the value is the last that was tried, and errs
};

// One knob after another, each searched on a logarithmic grid of kTuneGrid values, its default and its lower
// bound, then by golden section between the best one's neighbours; a method with two knobs goes round twice.
// Where several neighbouring values are equally good, the middle one is taken. Deterministic. Throws Interrupted.
inline constexpr int kTuneGrid = 13;
TunedMethod tune(TuningEvaluator& evaluator, const Method& start);

}  // namespace gnomon
