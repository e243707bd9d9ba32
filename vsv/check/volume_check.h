#pragma once
// Bit-for-bit comparison of a GPU's shadow volume with one computed on the CPU by the same shared functions, from the
// GPU's occluders or from the map they came from.
//
// The two can differ only by the rounding of transcendental functions (docs/shared_glsl.md). A voxel whose centre is
// nearer to the occluder than that is counted separately; any other difference is a bug.

#include "vsv/check/dense_volume.h"

namespace gnomon {

// By how much a column's alpha_occ may differ between two processors, radians (volume_check.cpp derives it).
float alphaTolerance(float alphaOccluder, float phi);

// Measured bits against those that occluders imply.
struct BitsCheck {
  uint64_t voxels = 0;
  uint64_t mismatches = 0;       // beyond the tolerance
  uint64_t withinTolerance = 0;  // differing voxels whose centre lies within it
};
// `tolerances`: radians a column; empty where both sides were given the same occluders, bit for bit.
BitsCheck checkBits(const DenseVolume& measured, std::span<const float> alphaOccluders,
                    std::span<const float> tolerances);

// Occluders of the GPU against the CPU's.
struct OccluderCheck {
  uint64_t columns = 0;
  uint64_t equal = 0;            // to the bit
  uint64_t withinTolerance = 0;  // and not equal
  uint64_t beyond = 0;
  float largest = 0.0f;  // difference, radians, of those that are finite on both sides
};
OccluderCheck checkOccluders(std::span<const float> measured, std::span<const float> expected,
                             std::span<const float> tolerances);

}  // namespace gnomon
