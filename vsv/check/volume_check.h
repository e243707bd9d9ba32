#pragma once
// Whether a GPU's shadow volume is the one that its source implies: computed again on the CPU, from the
// occluders or from one step before, by the same shared mathematics, and compared bit for bit.
//
// What separates the two is the transcendental functions alone (STYLE's list of what is exact). A voxel whose
// centre lies nearer the occluder than those can move it is counted apart; any other difference is a defect.

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
