#pragma once
// A map's images unfolded into one picture, and the solid angles of its texels.

#include "base/image.h"
#include "shadow/parameterization.h"

#include <optional>

namespace gnomon {

// Slices side by side (as DepthImages has them) laid out as they lie around the light; `outside` where there
// is no texel (FittedMap::unfoldedAt).
//
//   cube        +Y           paraboloid  two discs      others  side by side
//            -X +Z +X -Z
//               -Y           seen from the light
Image8 unfoldedPicture(const Image8& layers, const FittedMap& fitted, const glm::u8vec3& outside);

// Steradians of the smallest and the largest texel, and of all. Absent for directional maps, whose rays are parallel.
// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983, of the two halves of each texel.
struct SolidAngles {
  double smallest = 0.0, largest = 0.0, sum = 0.0;
};
std::optional<SolidAngles> computeSolidAngles(const FittedMap& fitted);

}  // namespace gnomon
