#pragma once
// Small volumes that a test can reason about.

#include "vsv/check/dense_volume.h"

#include "shared/light_frame.glsl"

#include <cstdint>
#include <vector>

namespace gnomon::test {

// alpha in [0.1, 2.9], all of theta, phi in [0, pi - 0.1]; the eye 5 metres from the light.
glsl::EpipolarGrid fullGrid(int alphaCount, int thetaCount, int phiCount);

// A frame with no axis along the world's, orthonormal to a float's rounding; the light at (1, 2, 3).
glsl::LightFrame tiltedFrame();

// One alpha a column: anywhere in the volume, before it, behind it, infinite, and on voxels' very centres.
std::vector<float> randomOccluders(const glsl::EpipolarGrid& grid, uint32_t seed);

// Alpha that changes slowly from column to column, so that whole blocks are alike.
std::vector<float> smoothOccluders(const glsl::EpipolarGrid& grid);

}  // namespace gnomon::test
