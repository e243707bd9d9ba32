#pragma once
// The density of a heterogeneous medium in a device's memory (density.h puts it there), and how what lies between it
// and a light is tabulated.

#include "gpu/resources.h"
#include "scene/scene.h"

#include "shared/density.glsl"

namespace gnomon {

struct DensityBuffers {
  gpu::Buffer words;  // NanoVDB
  gpu::Buffer place;  // glsl::DensityPlace, a uniform buffer
  Bounds boundsW;
  double voxelMetres = 0.0;
};

// How the table of density between a light and the points about it is laid out for these bounds.
glsl::LightReach lightReach(const Bounds& boundsW, double voxelMetres, const glm::dvec3& lightW);

}  // namespace gnomon
