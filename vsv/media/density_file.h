#pragma once
// A density's OpenVDB file, read in a process of its own (base/child.h): OpenVDB trusts what a file says of its sizes.

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace gnomon {

// What DensityGrid is made of; world space is the file's.
struct DensityFile {
  struct Facts {
    glm::dvec3 lowerI{0.0}, upperI{0.0};  // first and last active voxel
    glm::dvec3 centerW{0.0};              // of those two
    glm::dmat3 worldFromIndex{1.0};       // of differences
    uint64_t activeVoxels = 0;
  };
  std::string path, gridName;
  Facts facts;
  std::string nanoVdb;  // the whole grid
};

// "FILE.vdb", or "FILE.vdb:GRID" where the file has several. Throws WorldError as DensityGrid does.
DensityFile readDensityFile(const std::string& fileAndGrid);
// The same of bytes, and in this process, which a damaged file may then crash.
DensityFile readDensityBytes(const std::string& fileAndGrid, std::string bytes);

// What readDensityFile has done in the process of its own (src/child): facts, name and grid as bytes.
inline constexpr const char* kDensityWork = "density";
std::string packedDensity(const std::vector<std::string>& pathAndGrid, std::string bytes);

}  // namespace gnomon
