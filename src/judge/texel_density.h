#pragma once
// Texel density: how many texels of a map fall on a square metre of visible surface.

#include "shadow/parameterization.h"
#include "truth/receivers.h"

namespace gnomon {

// Texels per square metre on the plane through a point with this unit normal: one over the area that the four rays at
// half a texel's distance from the point's own cut out of it, for any parameterization. 0 where a ray does not meet the
// plane (grazing light: the texel has no end); nothing where the map does not cover the point.
std::optional<double> texelDensity(const FittedMap& fitted, const glm::dvec3& positionW, const glm::dvec3& normalW);

// One a pixel: its density where it is scored and covered, 0 as above, negative elsewhere. All cores.
std::vector<float> texelDensities(const FittedMap& fitted, const Receivers& receivers);

// The median over the pixels that have one; 0 where none has.
double medianDensity(std::span<const float> densities);

}  // namespace gnomon
