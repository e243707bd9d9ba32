#pragma once
// The density of a heterogeneous medium: a float grid from an OpenVDB file, placed in the world; on the CPU as it is,
// on the GPU as a NanoVDB grid. OpenVDB's and NanoVDB's headers stay in the .cpp files.
//
// A point's density is the grid's value there, trilinear, and 0 where that is negative or outside of the
// active voxels' box (grown by one voxel, over which the values fall to the background).

#include "truth/media_reference.h"
#include "vsv/media/density_buffers.h"

#include "shared/density.glsl"

#include <memory>
#include <optional>
#include <span>
#include <string>

namespace gnomon {

// What is done with the file's own place, in this order.
struct DensityPlacement {
  double scale = 1.0;                 // of its size, about the centre of its bounds
  double turnDegrees = 0.0;           // about that centre and the y axis, counter-clockwise seen from above
  std::optional<glm::dvec3> centerW;  // where that centre goes, metres; absent: where it is
  glm::dvec3 originW{0.0};            // Scene::originW: both are in the scene file's coordinates
};

class DensityGrid final : public DensityField {
 public:
  // "FILE.vdb", or "FILE.vdb:GRID" where the file has several grids. Throws WorldError: no such file, not a
  // .vdb, no such grid (lists those there are), not of floats, a level set, nothing in it, values that are
  // not finite, a transform that is not affine.
  DensityGrid(const std::string& fileAndGrid, const DensityPlacement& placement);
  ~DensityGrid() override;
  DensityGrid(const DensityGrid&) = delete;
  DensityGrid& operator=(const DensityGrid&) = delete;

  double at(const glm::dvec3& posW) const override;
  Bounds boundsW() const override;
  double voxelMetres() const override;  // the shortest side

  const std::string& gridName() const { return gridName_; }
  const glsl::DensityPlace& place() const { return place_; }
  std::span<const std::byte> nanoVdb() const;  // the whole grid, as shaders read it
  uint64_t activeVoxels() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string gridName_;
  glsl::DensityPlace place_{};
};

// A grid in a device's memory. Throws WorldError where it is larger than the device's largest buffer.
DensityBuffers createDensityBuffers(const gpu::Device& device, const DensityGrid& grid);

}  // namespace gnomon
