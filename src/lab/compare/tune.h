#pragma once
// The best value of a bias's knobs for one picture: fairness towards methods that have any. All evaluations
// share one map and one truth, and each pixel's label is found once (a pixel that is wrong in the same way,
// by the same texel, is wrong for the same reason whatever the knob says).

#include "lab/core/map_set.h"

namespace gnomon {

// Counts the pixels a bias is answerable for (acne + leak), again and again.
class Trial {
 public:
  Trial(const Session& session, Passes& passes, const Exact& exact, MapSet& maps)
      : session_(session), passes_(passes), exact_(exact), maps_(maps) {}

  size_t biasErrors(const Method& method);
  double scored() const { return static_cast<double>(exact_.receivers.scored); }
  float sceneScale() const { return maps_.fitted().map.sceneScale; }  // metres
  int evaluations() const { return evaluations_; }

 private:
  struct Known {  // of a wrong pixel
    uint32_t texel = 0;
    Label label = Label::NotScored;
  };

  const Session& session_;
  Passes& passes_;
  const Exact& exact_;
  MapSet& maps_;
  std::vector<Known> shadowed_, lit_;  // wrongly so; one a pixel
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
TunedMethod tune(Trial& trial, const Method& start);

}  // namespace gnomon
