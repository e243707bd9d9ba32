#pragma once
// Distances from a point light to the nearest and the farthest caster: the near and far ends of maps that cover all
// directions.

#include "shadow/parameterization.h"

#include <optional>
#include <span>

#include <glm/glm.hpp>

namespace gnomon {

// How far a point is from the light.
enum class Distance {
  Radial,  // its Euclidean distance
  Axial,   // its largest coordinate: metres along the axis of the cube face it falls on
};

// Metres to the nearest point of any triangle, and not less than `least`; `farthest` where there is none nearer.
double nearestCaster(const Scene& scene, const glm::dvec3& lightW, Distance distance, double least, double farthest);

// Metres to the farthest of the points, or to the farthest corner of the scene where there are none.
double farthestReceiver(const Scene& scene, const glm::dvec3& lightW, Distance distance,
                        std::span<const glm::dvec3> receiversW);

// Both ends, kept clear of what they were fitted to.
struct DepthEnds {
  double zNear = 0.0, zFar = 1.0;  // metres
  bool operator==(const DepthEnds&) const = default;
};
DepthEnds fitDepthEnds(const Scene& scene, const glm::dvec3& lightW, Distance distance,
                       std::span<const glm::dvec3> receiversW);

// Ends that a renderer chooses, without triangles or receivers: from its light's near distance to the farthest corner
// of its scene's bounds.
DepthEnds depthEndsWithin(const Bounds& sceneBoundsW, const glm::dvec3& lightW, Distance distance, double zNear);

// The user's, of cubes and paraboloids; none: they are fitted.
extern const WrittenOption<std::optional<DepthEnds>> kDepthRange;
DepthEnds chosenDepthEnds(const FitInput& input, Distance distance);

}  // namespace gnomon
