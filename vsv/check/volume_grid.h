#pragma once
// A shadow volume as a sparse OpenVDB mask grid: index space is (alpha, theta, phi), active is occluded,
// whole blocks are tiles. Comparison is by the grids' topology. OpenVDB's headers stay in the .cpp files.

#include "vsv/check/dense_volume.h"

#include <filesystem>
#include <memory>
#include <string>

#include <glm/glm.hpp>

#include "shared/light_frame.glsl"

namespace gnomon {

class VolumeGrid {
 public:
  explicit VolumeGrid(const DenseVolume& volume);
  ~VolumeGrid();
  VolumeGrid(VolumeGrid&&) noexcept;
  VolumeGrid& operator=(VolumeGrid&&) noexcept;

  bool occluded(int alpha, int theta, int phi) const;
  uint64_t activeVoxels() const;
  uint64_t memoryBytes() const;
  uint64_t tileCount() const;  // blocks of 8^3 voxels and more that are whole
  uint64_t leafCount() const;  // blocks of 8^3 voxels that the boundary passes through

  struct Impl;  // volume_grid.cpp and vdb_file.cpp
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

struct GridDifference {
  uint64_t both = 0, onlyFirst = 0, onlySecond = 0;  // voxels
};
GridDifference compareGrids(const VolumeGrid& first, const VolumeGrid& second);

}  // namespace gnomon
