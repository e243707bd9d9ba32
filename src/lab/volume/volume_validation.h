#pragma once
// `gnomon vsv`: a shadow volume, built on the GPU and checked on the CPU.

#include "lab/core/session.h"
#include "lab/results/schema.h"
#include "vsv/check/source_check.h"
#include "vsv/check/vdb_file.h"
#include "vsv/check/volume_grid.h"

#include <filesystem>
#include <optional>

namespace gnomon {

struct VolumeOptions {
  MapOptions map;      // size, source and fit of the volume
  int mapSide = 1024;  // texels, of the cube map that `resample` looks columns up in
  CullMode cull = CullMode::Solids;
  bool validate = false;
  std::filesystem::path outDir;  // empty: no pictures
  std::filesystem::path vdb;     // empty: no file
  double vdbVoxel = 0.0;         // metres; 0: the mean voxel
  std::string command;           // told in the file
};

// What --validate finds.
struct VolumeValidation {
  SourceCheck source;                // (a): the volume that the same map implies
  GridDifference impliedDifference;  // the same by topology: the GPU's grid first
  uint64_t litBehind = 0;            // voxels lit behind an occluded one: the scan failed
  BoundaryErrors exact;              // (b): the volume that Embree's rays give
  GridDifference exactDifference;
};

struct VolumeTimes {  // milliseconds of wall clock
  double fit = 0.0;
  double build = 0.0;  // all stages in one submission
  double bits = 0.0;   // the bits alone, in a submission of their own
  double download = 0.0, grid = 0.0;
  double implied = 0.0, trace = 0.0, compareExact = 0.0, vdb = 0.0;
};

struct VolumeResult {
  FittedMap columns;
  Light light;
  uint64_t voxels = 0, occluded = 0;
  uint64_t denseBytes = 0, gridBytes = 0, gridTiles = 0, gridLeaves = 0;
  std::optional<VolumeValidation> validation;
  std::optional<VdbSummary> vdb;
  Pictures pictures;  // name, path below outDir
  VolumeTimes times;

  // Whether the GPU's volume is the one its source implies.
  bool sound() const;
};

// Throws WorldError and UsageError.
VolumeResult examineVolume(const Session& session, const VolumeOptions& options);

}  // namespace gnomon
