#pragma once
// Ray-traced ground truth for one light in one picture: the pixels to score, and which of them are lit.

#include "judge/scene_view.h"
#include "shadow/parameterization.h"
#include "truth/visibility.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace gnomon {

struct GroundTruth {
  Light source;      // as the scene or the command line has it
  LightModel light;  // as it is traced
  Receivers receivers;
  Truth truth;
  double ms = 0.0;  // wall clock of both, and of the view's surfaces where they were not known
};
// Nothing may be scored.
GroundTruth traceGroundTruth(const SceneView& view, const Light& source, const LightModel& light);

// The ground truths of a view, each traced once: maps that take a light alike have one in common.
class GroundTruths {
 public:
  std::shared_ptr<const GroundTruth> of(const SceneView& view, const Light& source, const LightModel& light);
  size_t tracedCount() const { return tracedCount_; }
  // All but the newest are forgotten: of a light that moves none comes again.
  void keepNewest(size_t count) { kept_.resize(std::min(count, kept_.size())); }

 private:
  std::vector<std::shared_ptr<const GroundTruth>> kept_;  // the last ones first
  size_t tracedCount_ = 0;
};

// The scene's first light of a kind that the map is made for, else the first that it can make do with; null where
// there is none.
const Light* firstLightFor(const Scene& scene, const Parameterization& map);

// The light as the map takes it. One without a direction of its own is made to shine, where the map needs one, along
// the mean direction of the surfaces in the picture that it lights (of all it faces, where it lights none).
LightModel lightTakenBy(const Parameterization& map, const SceneView& view, const Light& source);

}  // namespace gnomon
