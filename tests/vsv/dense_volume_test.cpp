// A volume as bits and as boundaries, and the occupancy rule by brute force.
#include "vsv/check/dense_volume.h"
#include "volumes_by_hand.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

using namespace test;

TEST(DenseVolume, AVoxelIsOccludedExactlyWhenItsCentreLiesBehindTheOccluder) {
  const glsl::EpipolarGrid grid = fullGrid(97, 64, 128);
  const std::vector<float> occluders = randomOccluders(grid, 1);
  const DenseVolume volume = volumeOf(impliedBoundaries(grid, occluders));
  uint64_t wrong = 0, occluded = 0;
  for (int alpha = 0; alpha < grid.alphaCount; ++alpha)
    for (int theta = 0; theta < grid.thetaCount; ++theta)
      for (int phi = 0; phi < grid.phiCount; ++phi) {
        const bool behind = glsl::alphaCenter(grid, alpha) > occluders[columnIndex(grid, theta, phi)];
        if (behind) ++occluded;
        if (volume.bit(alpha, theta, phi) != behind) ++wrong;
      }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(occludedCount(volume), occluded);
  EXPECT_EQ(voxelCount(grid), 97u * 64u * 128u);
  EXPECT_GT(occluded, voxelCount(grid) / 4);
}

TEST(DenseVolume, BoundariesAreFoundAgainInTheBits) {
  const glsl::EpipolarGrid grid = fullGrid(50, 40, 128);
  const ColumnBoundaries implied = impliedBoundaries(grid, randomOccluders(grid, 2));
  const FoundBoundaries found = boundariesOf(volumeOf(implied));
  EXPECT_EQ(found.boundaries.first, implied.first);
  EXPECT_EQ(found.litBehind, 0u);
}

TEST(DenseVolume, AVoxelThatIsLitBehindAnOccludedOneIsCounted) {
  const glsl::EpipolarGrid grid = fullGrid(50, 40, 128);
  ColumnBoundaries implied = impliedBoundaries(grid, randomOccluders(grid, 3));
  implied.first[columnIndex(grid, 7, 100)] = 10;
  DenseVolume volume = volumeOf(implied);
  volume.flip(20, 7, 100);
  volume.flip(49, 7, 100);
  const FoundBoundaries found = boundariesOf(volume);
  EXPECT_EQ(found.litBehind, 2u);
  EXPECT_EQ(found.boundaries.first, implied.first);
}

}  // namespace
}  // namespace gnomon
