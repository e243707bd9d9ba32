#pragma once
// Shadow volumes in host memory, in the two forms that the CPU's check compares: one bit a voxel, and one shadow
// boundary a column (shaders/shared/epipolar.glsl has the grid and the occupancy rule).

#include "shared/epipolar.glsl"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

inline constexpr int kWordBits = 64;  // voxels along phi in a word

// One bit a voxel: 1 occluded. Phi fastest, then theta, then alpha: no layout that a GPU would choose, so
// that reading a GPU's volume into it tests that layout too.
struct DenseVolume {
  glsl::EpipolarGrid grid{};
  std::vector<uint64_t> words;

  explicit DenseVolume(const glsl::EpipolarGrid& of);
  int phiWordCount() const { return grid.phiCount / kWordBits; }
  size_t wordIndex(int alpha, int theta, int phiWord) const {
    return (static_cast<size_t>(alpha) * grid.thetaCount + theta) * phiWordCount() + phiWord;
  }
  bool bit(int alpha, int theta, int phi) const {
    return (words[wordIndex(alpha, theta, phi / kWordBits)] >> (phi % kWordBits) & 1u) != 0;
  }
  void flip(int alpha, int theta, int phi) {
    words[wordIndex(alpha, theta, phi / kWordBits)] ^= uint64_t{1} << (phi % kWordBits);
  }
};

uint64_t voxelCount(const glsl::EpipolarGrid& grid);
uint64_t occludedCount(const DenseVolume& volume);

inline size_t columnCount(const glsl::EpipolarGrid& grid) {
  return static_cast<size_t>(grid.thetaCount) * grid.phiCount;
}
inline size_t columnIndex(const glsl::EpipolarGrid& grid, int theta, int phi) {
  return static_cast<size_t>(phi) * grid.thetaCount + theta;  // theta fastest
}

// The first occluded voxel of each column, 0 .. alphaCount: the count where nothing is occluded. All voxels
// behind it are occluded too.
struct ColumnBoundaries {
  glsl::EpipolarGrid grid{};
  std::vector<int> first;  // by columnIndex
};

// What the occupancy rule makes of occluders: alpha a column, radians, infinity where there is none.
ColumnBoundaries impliedBoundaries(const glsl::EpipolarGrid& grid, std::span<const float> alphaOccluders);

// All cores.
DenseVolume volumeOf(const ColumnBoundaries& boundaries);

// Where each column's first occluded voxel is, and how many voxels are lit behind it: none, or a scan failed.
struct FoundBoundaries {
  ColumnBoundaries boundaries;
  uint64_t litBehind = 0;
};
FoundBoundaries boundariesOf(const DenseVolume& volume);

}  // namespace gnomon
