#pragma once
// The points that each cascade of a planar map must cover, for the chosen fit.

#include "planar/window.h"
#include "shadow/parameterization.h"

namespace gnomon {

// Plane coordinates, of which a slice covers the convex hull: one set a cascade, the nearest to the camera
// first. None is empty: a cascade without receivers covers what the next one does.
std::vector<std::vector<glm::dvec2>> slicePoints(const FitInput& input, const AxisFrame& frame,
                                                 const Bounds& sceneBounds, int cascadeCount);

// Depth before which a spot sees nothing, metres.
double leastCasterDepth(const Bounds& sceneBounds);

}  // namespace gnomon
