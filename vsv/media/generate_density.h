#pragma once
// Generated densities, so that no download is needed: deterministic, fitted to a scene's bounds, written as .vdb files
// with one float grid, `density`, in metres.

#include "scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

struct GeneratedDensity {
  const char* name;
  const char* sentence;
};

// In the order `gnomon scene` lists them.
const std::vector<GeneratedDensity>& generatedDensities();

struct DensitySummary {
  uint64_t voxels = 0;  // active
  double voxelMetres = 0.0;
};
// `seed` counts for turbulence only. Throws UsageError (no such name; lists them) and WorldError (bounds
// without extent, a file that cannot be written).
DensitySummary writeGeneratedDensity(const std::string& name, const Bounds& boundsW, uint32_t seed,
                                     const std::filesystem::path& path);

}  // namespace gnomon
