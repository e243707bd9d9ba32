#pragma once
// The cube map: six planar slices of 90 degrees around a point light, with the axes of the world. Its
// mathematics is shaders/shared/cube_map.glsl.
//
// Two kinds of depth (kCubeDepth). Hyperbolic is the rasterizer's z/w of each face, needs no
// fragment shader, and its near end is the nearest caster along any face's axis. Radial is linear in the
// distance from the light, the same on both sides of an edge; its near end is the nearest caster's distance,
// and the faces' near planes stand at 1/sqrt(3) of that, since a face's corner is sqrt(3) farther from the
// light than along its axis.

#include "shadow/parameterization.h"

namespace gnomon {

enum class CubeDepth { Hyperbolic, Radial };

extern const ChoiceOption<CubeDepth> kCubeDepth;
extern const ChoiceOption<SlicePasses> kCubePasses;

const Parameterization& cubeParameterization();

// A cube map with these ends of depth, metres.
FittedMap makeCubeMap(const glm::dvec3& lightW, CubeDepth depth, double zNear, double zFar, int side, float sceneScale);

}  // namespace gnomon
