#include "vsv/check/dense_volume.h"

#include "base/check.h"

#include <bit>
#include <functional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace gnomon {

namespace {

using Range = tbb::blocked_range<int>;

uint64_t sumOverAlpha(const DenseVolume& volume, const std::function<uint64_t(int alpha)>& count) {
  return tbb::parallel_reduce(
      Range(0, volume.grid.alphaCount), uint64_t{0},
      [&](const Range& range, uint64_t sum) {
        for (int i = range.begin(); i != range.end(); ++i) sum += count(i);
        return sum;
      },
      std::plus<>());
}

}  // namespace

DenseVolume::DenseVolume(const glsl::EpipolarGrid& of) : grid(of) {
  GNOMON_CHECK_EQ(grid.phiCount % kWordBits, 0);
  words.assign(wordIndex(grid.alphaCount, 0, 0), 0);
}

uint64_t voxelCount(const glsl::EpipolarGrid& grid) {
  return static_cast<uint64_t>(columnCount(grid)) * grid.alphaCount;
}

uint64_t occludedCount(const DenseVolume& volume) {
  return sumOverAlpha(volume, [&](int alpha) {
    uint64_t count = 0;
    for (size_t w = volume.wordIndex(alpha, 0, 0); w < volume.wordIndex(alpha + 1, 0, 0); ++w)
      count += std::popcount(volume.words[w]);
    return count;
  });
}

ColumnBoundaries impliedBoundaries(const glsl::EpipolarGrid& grid, std::span<const float> alphaOccluders) {
  GNOMON_CHECK_EQ(alphaOccluders.size(), columnCount(grid));
  ColumnBoundaries boundaries{grid, std::vector<int>(alphaOccluders.size())};
  for (size_t c = 0; c < alphaOccluders.size(); ++c) boundaries.first[c] = glsl::firstOccluded(grid, alphaOccluders[c]);
  return boundaries;
}

DenseVolume volumeOf(const ColumnBoundaries& boundaries) {
  const glsl::EpipolarGrid& grid = boundaries.grid;
  DenseVolume volume(grid);
  tbb::parallel_for(Range(0, grid.thetaCount), [&](const Range& thetas) {
    std::vector<int> first(grid.phiCount);
    for (int theta = thetas.begin(); theta != thetas.end(); ++theta) {
      for (int phi = 0; phi < grid.phiCount; ++phi) first[phi] = boundaries.first[columnIndex(grid, theta, phi)];
      for (int alpha = 0; alpha < grid.alphaCount; ++alpha) {
        uint64_t* words = &volume.words[volume.wordIndex(alpha, theta, 0)];
        for (int phi = 0; phi < grid.phiCount; ++phi)
          words[phi / kWordBits] |= static_cast<uint64_t>(first[phi] <= alpha) << (phi % kWordBits);
      }
    }
  });
  return volume;
}

FoundBoundaries boundariesOf(const DenseVolume& volume) {
  const glsl::EpipolarGrid& grid = volume.grid;
  FoundBoundaries found{{grid, std::vector<int>(columnCount(grid), grid.alphaCount)}};
  found.litBehind = tbb::parallel_reduce(
      Range(0, grid.thetaCount), uint64_t{0},
      [&](const Range& thetas, uint64_t litBehind) {
        for (int theta = thetas.begin(); theta != thetas.end(); ++theta) {
          for (int w = 0; w < volume.phiWordCount(); ++w) {
            uint64_t reached = 0;  // columns whose boundary lies nearer the light
            for (int alpha = 0; alpha < grid.alphaCount; ++alpha) {
              const uint64_t word = volume.words[volume.wordIndex(alpha, theta, w)];
              for (uint64_t fresh = word & ~reached; fresh != 0; fresh &= fresh - 1)
                found.boundaries.first[columnIndex(grid, theta, w * kWordBits + std::countr_zero(fresh))] = alpha;
              litBehind += std::popcount(reached & ~word);
              reached |= word;
            }
          }
        }
        return litBehind;
      },
      std::plus<>());
  return found;
}

}  // namespace gnomon
