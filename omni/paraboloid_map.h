#pragma once
// The dual paraboloid map: two layers, each a hemisphere around a point light, depth linear in the distance.
// Its mathematics is shaders/shared/paraboloid_map.glsl; the frame's -z is the axis of slice 0, and the seam
// is the great circle across it.
//
// Three rasterizers (kParaboloidRaster), because straight edges project to arcs. `vertex` projects the vertices and
// draws straight edges: wrong for large triangles. `tessellated` cuts triangles until straight edges are right to half
// a texel (shaders/shared/paraboloid_pieces.glsl). `exact` draws a bound of every triangle and runs one ray-triangle
// test a texel. Triangles are cut by a compute shader, because the hardware tessellator cuts evenly and at most 64
// times: too little where a light is close to a large floor, and too much elsewhere.

#include "shadow/parameterization.h"

#include <optional>

namespace gnomon {

// How the triangles of a dual paraboloid are rasterized.
enum class ParaboloidRaster {
  Vertex,       // corners are projected, edges are drawn straight: wrong for large triangles (Brabec et al. 2002)
  Tessellated,  // the same, of triangles cut until their edges are straight to within half a texel
  Exact,        // each texel's ray meets the triangle or does not
};

extern const ChoiceOption<ParaboloidRaster> kParaboloidRaster;
// Of any length; none: the seam is turned away from what the camera sees.
extern const WrittenOption<std::optional<glm::dvec3>> kParaboloidAxisW;

const Parameterization& paraboloidParameterization();

// A paraboloid map with this axis (unit) and these ends of depth, metres.
FittedMap makeParaboloidMap(const glm::dvec3& lightW, const glm::dvec3& axisW, ParaboloidRaster raster, double zNear,
                            double zFar, int side, float sceneScale);

// The axis that turns the seam away from what is seen: of directions spread evenly over a hemisphere, the one
// for which the receiver at the 5th percentile of the angle to the seam is farthest from it. (The nearest one
// decides nothing where receivers lie all around the light: some are on any seam.) Unit; slice 0 looks at the
// greater part. Straight down where there are no receivers.
glm::dvec3 seamAvoidingAxis(const glm::dvec3& lightW, std::span<const glm::dvec3> receiversW);

}  // namespace gnomon
