#pragma once
// Tuning: the parameter values of a bias with the least acne + leak for one picture, so that biases with parameters are
// compared fairly. All evaluations share one map and one ground truth. Labels are cached: a pixel that is wrong in the
// same way, by the same texel, has the same label whatever the parameters.

#include "judge/light_on_map.h"

namespace gnomon {

// Counts the pixels a bias is answerable for (acne + leak), again and again.
class TuningEvaluator {
 public:
  explicit TuningEvaluator(LightOnMap& lit) : lit_(lit) {}

  size_t biasErrors(const Method& method);
  double scored() const { return static_cast<double>(lit_.receivers().scored); }
  float sceneScale() const { return lit_.fitted().map.sceneScale; }  // metres
  int evaluations() const { return evaluations_; }

 private:
  struct Known {  // of a wrong pixel
    uint32_t texel = 0;
    Label label = Label::NotScored;
  };

  LightOnMap& lit_;
  std::vector<Known> wronglyShadowed_, wronglyLit_;  // one a pixel
  int evaluations_ = 0;
};

struct TunedMethod {
  Method method;
  size_t biasErrors = 0;
  int evaluations = 0;
};

// One knob after another, each searched on a logarithmic grid of kTuneGrid values, its default and its lower
// bound, then by golden section between the best one's neighbours; a method with two knobs goes round twice.
// Where several neighbouring values are equally good, the middle one is taken. Deterministic.
inline constexpr int kTuneGrid = 13;
TunedMethod tune(TuningEvaluator& evaluator, const Method& start);

}  // namespace gnomon
