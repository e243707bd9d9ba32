// The sparse grid holds the dense volume's very voxels, whatever their pattern, in less memory where it is smooth.
#include "vsv/check/volume_grid.h"
#include "volumes_by_hand.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

namespace gnomon {
namespace {

using namespace test;

DenseVolume randomBits(const glsl::EpipolarGrid& grid, uint32_t seed) {
  std::mt19937_64 random(seed);
  DenseVolume volume(grid);
  for (uint64_t& word : volume.words) word = random() & random();
  return volume;
}

// Sizes that no block of eight divides, and bits that no rule makes.
TEST(VolumeGrid, HoldsEveryVoxelOfADenseVolume) {
  for (const bool monotone : {true, false}) {
    const glsl::EpipolarGrid grid = fullGrid(37, 21, 128);
    const DenseVolume volume =
        monotone ? volumeOf(impliedBoundaries(grid, randomOccluders(grid, 7))) : randomBits(grid, 8);
    const VolumeGrid sparse(volume);
    EXPECT_EQ(sparse.activeVoxels(), occludedCount(volume));
    uint64_t wrong = 0;
    for (int alpha = -3; alpha < grid.alphaCount + 9; ++alpha)
      for (int theta = -3; theta < grid.thetaCount + 9; ++theta)
        for (int phi = -3; phi < grid.phiCount + 9; ++phi) {
          const bool inside = alpha >= 0 && theta >= 0 && phi >= 0 && alpha < grid.alphaCount &&
                              theta < grid.thetaCount && phi < grid.phiCount;
          if (sparse.occluded(alpha, theta, phi) != (inside && volume.bit(alpha, theta, phi))) ++wrong;
        }
    EXPECT_EQ(wrong, 0u) << monotone;
  }
}

TEST(VolumeGrid, WholeBlocksAreTilesAndSaveMemory) {
  const glsl::EpipolarGrid grid = fullGrid(256, 256, 256);
  const DenseVolume volume = volumeOf(impliedBoundaries(grid, smoothOccluders(grid)));
  const VolumeGrid sparse(volume);
  EXPECT_EQ(sparse.activeVoxels(), occludedCount(volume));
  EXPECT_GT(sparse.tileCount(), 1000u);
  // The boundary is a surface: a leaf or two, three where it is steep, for each 8 x 8 columns.
  EXPECT_LT(sparse.leafCount(), 3u * 32u * 32u);
  EXPECT_GE(sparse.leafCount(), 32u * 32u);

  const DenseVolume full = volumeOf({grid, std::vector<int>(columnCount(grid), 0)});
  const VolumeGrid allTiles(full);
  EXPECT_EQ(allTiles.activeVoxels(), voxelCount(grid));
  EXPECT_EQ(allTiles.leafCount(), 0u);
  EXPECT_LE(allTiles.tileCount(), 8u);  // 128^3 each
  EXPECT_LT(allTiles.memoryBytes(), full.words.size() * 8);
  EXPECT_EQ(VolumeGrid(DenseVolume(grid)).activeVoxels(), 0u);
}

TEST(VolumeGrid, ComparisonByTopologyCountsWhatTheBitsCount) {
  const glsl::EpipolarGrid grid = fullGrid(128, 64, 128);
  const DenseVolume a = volumeOf(impliedBoundaries(grid, smoothOccluders(grid)));
  DenseVolume b = randomBits(grid, 9);
  for (size_t w = 0; w < b.words.size() / 2; ++w) b.words[w] = a.words[w];  // whole tiles alike
  uint64_t both = 0, onlyA = 0, onlyB = 0;
  for (size_t w = 0; w < a.words.size(); ++w) {
    both += std::popcount(a.words[w] & b.words[w]);
    onlyA += std::popcount(a.words[w] & ~b.words[w]);
    onlyB += std::popcount(b.words[w] & ~a.words[w]);
  }
  const GridDifference difference = compareGrids(VolumeGrid(a), VolumeGrid(b));
  EXPECT_EQ(difference.both, both);
  EXPECT_EQ(difference.onlyFirst, onlyA);
  EXPECT_EQ(difference.onlySecond, onlyB);
  EXPECT_GT(onlyA, 0u);
  EXPECT_GT(onlyB, 0u);

  const GridDifference same = compareGrids(VolumeGrid(a), VolumeGrid(a));
  EXPECT_EQ(same.both, occludedCount(a));
  EXPECT_EQ(same.onlyFirst + same.onlySecond, 0u);
}

TEST(VolumeGrid, AFlippedBitInTheMiddleOfATileIsOneVoxel) {
  const glsl::EpipolarGrid grid = fullGrid(256, 128, 128);
  const DenseVolume a = volumeOf({grid, std::vector<int>(columnCount(grid), 64)});
  DenseVolume b = a;
  b.flip(200, 77, 99);
  b.flip(3, 77, 99);
  const GridDifference difference = compareGrids(VolumeGrid(a), VolumeGrid(b));
  EXPECT_EQ(difference.onlyFirst, 1u);
  EXPECT_EQ(difference.onlySecond, 1u);
}

}  // namespace
}  // namespace gnomon
