#pragma once
// The points that each cascade of a planar map must cover, for the chosen fit.

#include "planar/convex_body.h"
#include "planar/window.h"
#include "shadow/parameterization.h"

namespace gnomon {

// Plane coordinates, of which a slice covers the convex hull: one set a cascade, the nearest to the camera
// first. None is empty: a cascade without receivers covers what the next one does.
std::vector<std::vector<glm::dvec2>> slicePoints(const FitInput& input, const AxisFrame& frame,
                                                 const Bounds& sceneBounds, int cascadeCount);

// Depth before which a spot sees nothing, metres.
double leastCasterDepth(const Bounds& sceneBounds);

// Leaves of a body what a camera sees, at view depths of at least `nearest` and at most `farthest`, metres, and what
// lies in the pyramid about a spot's cone, at a depth of at least `least`.
void cutToView(ConvexBody& body, const glsl::CameraView& camera, double nearest = 0.0, double farthest = 1e30);
void cutToCone(ConvexBody& body, const LightModel& light, const AxisFrame& frame, double least);

}  // namespace gnomon
