#pragma once
// Compares a GPU's shadow volume with a CPU rebuild from the same depth map: the map is downloaded, each column's
// occluder is found again (shaders/shared/volume_source.glsl), the occupancy rule is applied, and the bits are
// compared.

#include "vsv/check/exact_volume.h"
#include "vsv/check/volume_check.h"
#include "vsv/shadow_volume.h"

namespace gnomon {

DenseVolume denseOf(const VolumeBits& bits);

struct SourceCheck {
  OccluderCheck occluders;  // the GPU's against those found again
  // Columns whose ray lies so near a texel's border that transcendental rounding decides on the texel: the
  // neighbour's answer counts too.
  uint64_t betweenTexels = 0;
  ColumnBoundaries implied;  // of the occluders found again
  BitsCheck sameMap;         // the GPU's bits against what the occluders found again imply
  BitsCheck sameOccluders;   // and against what the GPU's own occluders imply: the rule and the scan alone
};
// `measured`: the volume's bits.
SourceCheck checkSource(const gpu::Device& device, const ShadowVolume& volume, const DenseVolume& measured);

// How the volume's source sees its columns, for compareBoundaries(). `volume` must outlive it.
ColumnSource columnSource(const ShadowVolume& volume);

}  // namespace gnomon
