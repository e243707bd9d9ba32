#pragma once
// Exports a shadow volume as a .vdb file with two grids:
//
//   density          float fog volume in world space, 1 where the light does not reach, voxels of equal size,
//                    world units metres
//   shadow_epipolar  mask, the voxels themselves: index (alpha, theta, phi), world units radians
//
// Both, and the file, carry what made them: gnomon_light and gnomon_eye (metres), gnomon_lower, gnomon_step
// (radians) and gnomon_counts of alpha, theta, phi, gnomon_source, gnomon_command.

#include "scene/scene.h"
#include "vsv/check/volume_grid.h"

#include <filesystem>
#include <string>

namespace gnomon {

struct VdbOptions {
  std::string source;        // gnomon_source
  std::string command;       // gnomon_command
  double voxelMetres = 0.0;  // of the density; 0: meanVoxel()
  Bounds boundsW;            // of the density: the scene's
  glsl::LightFrame frame;    // L of the volume
};

// At most this many voxels of the box that a density's voxel size is chosen for, 256^3; a size that is asked
// for may take up to kMostDensityVoxels.
inline constexpr double kMeanVoxelLimit = 0x1p24;
inline constexpr double kMostDensityVoxels = 0x1p31;

// Edge of a cube as large as the volume's mean voxel is within the bounds, metres, coarsened to the limit.
double meanVoxel(const glsl::EpipolarGrid& grid, const glsl::LightFrame& frame, const Bounds& boundsW);

struct VdbSummary {
  uint64_t densityVoxels = 0;  // active: in shadow
  double voxelMetres = 0.0;
  uint64_t fileBytes = 0;
};
// Whole or not at all. Throws UsageError (a voxel size that
// gives too many voxels) and WorldError (cannot be written).
VdbSummary writeVdb(const std::filesystem::path& path, const VolumeGrid& mask, const DenseVolume& volume,
                    const VdbOptions& options);

}  // namespace gnomon
