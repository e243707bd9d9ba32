#pragma once
// Fills a shadow volume: the map its occluders come from, the nearest occluder of each column, the bits.

#include "vsv/shadow_volume.h"

namespace gnomon {

// How the bits are made of the occluders. Both give the same bits.
enum class Voxelization {
  // One pass: an invocation takes 128 columns, clears their texels as far as a bit is set, sets the first
  // occluded voxel of each,
  // and ORs along alpha.
  Fused,
  // The papers' way: the whole volume is cleared, then the first voxels are set, then all is scanned.
  Passes,
};

class VolumeRenderer {
 public:
  explicit VolumeRenderer(const gpu::Device& device) : programs_(device) {}

  // Everything; stages "volume source", "volume occluders", "volume bits". `light` and `cull` as for a map.
  void record(gpu::Commands& commands, const MapRenderer& maps, const SceneBuffers& scene, ShadowVolume& volume,
              const LightModel& light, CullMode cull) const;

  // The bits alone, from what `volume.occluders()` holds.
  void recordBits(gpu::Commands& commands, const ShadowVolume& volume, Voxelization how) const;

 private:
  gpu::ComputePrograms programs_;  // compiled at first use
};

}  // namespace gnomon
