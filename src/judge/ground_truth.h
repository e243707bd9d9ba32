#pragma once
// Ray-traced ground truth for one light in one picture: the pixels to score, and which of them are lit.

#include "judge/scene_view.h"
#include "shadow/parameterization.h"
#include "truth/visibility.h"

namespace gnomon {

struct GroundTruth {
  Light source;      // as the scene or the command line has it
  LightModel light;  // as it is traced
  Receivers receivers;
  Truth truth;
  double ms = 0.0;  // wall clock of both
};
// Nothing may be scored.
GroundTruth traceGroundTruth(const SceneView& view, const Light& source, const LightModel& light);

// The scene's first light of a kind that the map is made for, else the first that it can make do with; null where
// there is none.
const Light* firstLightFor(const Scene& scene, const Parameterization& map);

// The light as the map takes it. One without a direction of its own is made to shine, where the map needs one, along
// the mean direction of the surfaces in the picture that it lights (of all it faces, where it lights none).
LightModel lightTakenBy(const Parameterization& map, const SceneView& view, const Light& source);

}  // namespace gnomon
