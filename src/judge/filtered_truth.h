#pragma once
// Filtered ground truth: the exact shadow, filtered with the same kernel as the map. A filtered map would show this at
// infinite resolution.
//
// Sample i of a pixel's kernel is a light ray through the map, kernelOffset texels from the receiver's. Where it meets
// the receiver's plane it is traced as the truth is. Blocked, it still counts as lit where the receiver is lit and the
// surface is continuous, seen from the light, from the receiver to the blocker (truth/labels.h): at a crease the plane
// runs on behind the wall, and nothing there casts a shadow. A ray that does not meet the plane between the map's near
// and far ends counts as the receiver's own ray does.

#include "shadow/filter.h"
#include "shadow/parameterization.h"
#include "truth/visibility.h"

#include <span>

namespace gnomon {

// One value a pixel, 0..1; 1 where there is no surface, 0 where a surface is not scored.
// All cores; deterministic.
std::vector<float> computeFilteredTruth(const Tracer& tracer, const LightModel& light, const Receivers& receivers,
                                        const Truth& truth, const FittedMap& fitted, const ChosenFilter& filter);

// Root of the mean squared difference of a visibility from a truth, over the scored pixels.
double scoredRmse(const Receivers& receivers, std::span<const float> visibility, std::span<const float> truth);

}  // namespace gnomon
