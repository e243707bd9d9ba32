// The check itself: silent about a right volume, and red, with the right count, about every defect made here.
#include "vsv/check/volume_check.h"
#include "volumes_by_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace gnomon {
namespace {

using namespace test;

class VolumeCheckTest : public ::testing::Test {
 protected:
  const glsl::EpipolarGrid grid_ = fullGrid(96, 40, 128);
  const std::vector<float> occluders_ = randomOccluders(grid_, 5);
  const ColumnBoundaries boundaries_ = impliedBoundaries(grid_, occluders_);

  uint64_t countColumns(const std::function<bool(int first)>& wanted) const {
    return std::ranges::count_if(boundaries_.first, wanted);
  }
  uint64_t mismatches(const DenseVolume& volume) const {
    const BitsCheck check = checkBits(volume, occluders_, {});
    EXPECT_EQ(check.withinTolerance, 0u);
    EXPECT_EQ(check.voxels, voxelCount(grid_));
    return check.mismatches;
  }

  // What the GPU does: the first occluded bit of each column, and an inclusive OR along alpha that leaves out
  // one row; -1: none.
  DenseVolume scanned(int skippedRow) const {
    DenseVolume volume(grid_);
    for (int phi = 0; phi < grid_.phiCount; ++phi)
      for (int theta = 0; theta < grid_.thetaCount; ++theta) {
        const int first = boundaries_.first[columnIndex(grid_, theta, phi)];
        if (first < grid_.alphaCount) volume.flip(first, theta, phi);
      }
    const size_t row = volume.wordIndex(1, 0, 0);
    std::vector<uint64_t> carried(row, 0);
    for (int alpha = 0; alpha < grid_.alphaCount; ++alpha) {
      if (alpha == skippedRow) continue;
      for (size_t w = 0; w < row; ++w) carried[w] = volume.words[alpha * row + w] |= carried[w];
    }
    return volume;
  }
};

TEST_F(VolumeCheckTest, ARightVolumeHasNoMismatch) {
  EXPECT_EQ(mismatches(volumeOf(boundaries_)), 0u);
  EXPECT_EQ(mismatches(scanned(-1)), 0u);
}

TEST_F(VolumeCheckTest, EveryFlippedBitIsFound) {
  DenseVolume volume = volumeOf(boundaries_);
  uint64_t flipped = 0;
  for (int alpha = 0; alpha < grid_.alphaCount; alpha += 5)
    for (int phi = 0; phi < grid_.phiCount; phi += 21) {
      volume.flip(alpha, (alpha * 7 + phi) % grid_.thetaCount, phi);
      EXPECT_EQ(mismatches(volume), ++flipped);
    }
}

TEST_F(VolumeCheckTest, AVolumeOffByOneVoxelIsFound) {
  ColumnBoundaries later = boundaries_, earlier = boundaries_;
  for (int& first : later.first) first = std::min(first + 1, grid_.alphaCount);
  for (int& first : earlier.first) first = std::max(first - 1, 0);
  EXPECT_EQ(mismatches(volumeOf(later)), countColumns([&](int first) { return first < grid_.alphaCount; }));
  EXPECT_EQ(mismatches(volumeOf(earlier)), countColumns([](int first) { return first > 0; }));
}

TEST_F(VolumeCheckTest, AScanThatSkipsARowIsFound) {
  for (const int row : {1, 40, grid_.alphaCount - 1}) {
    const DenseVolume volume = scanned(row);
    // The row keeps its own first bits, and those behind it lose what begins there.
    const uint64_t notCarriedIn = countColumns([&](int first) { return first < row; });
    const uint64_t notCarriedOn =
        countColumns([&](int first) { return first == row; }) * static_cast<uint64_t>(grid_.alphaCount - 1 - row);
    EXPECT_EQ(mismatches(volume), notCarriedIn + notCarriedOn) << row;
    EXPECT_EQ(boundariesOf(volume).litBehind, notCarriedIn + notCarriedOn) << row;
    EXPECT_GT(notCarriedIn + notCarriedOn, 0u);
  }
}

TEST_F(VolumeCheckTest, ColumnsThatAreExchangedAreFound) {
  ColumnBoundaries shifted = boundaries_;
  std::rotate(shifted.first.begin(), shifted.first.begin() + 1, shifted.first.end());
  uint64_t expected = 0;
  for (size_t c = 0; c < shifted.first.size(); ++c)
    expected += static_cast<uint64_t>(std::abs(shifted.first[c] - boundaries_.first[c]));
  EXPECT_EQ(mismatches(volumeOf(shifted)), expected);
  EXPECT_GT(expected, 0u);
}

// Only the voxel whose centre lies between the two occluders may differ, and only if it lies near enough.
TEST_F(VolumeCheckTest, AVoxelWithinTheToleranceIsCountedApart) {
  std::vector<float> occluders(columnCount(grid_), 2.0f);
  std::vector<float> tolerances(occluders.size(), 1e-5f);
  const float center = glsl::alphaCenter(grid_, 30);
  occluders[17] = center + 4e-6f;  // the voxel is lit; a GPU that says 8e-6 less has it occluded
  occluders[40] = center + 4e-5f;
  std::vector<float> measured = occluders;
  measured[17] = center - 4e-6f;
  measured[40] = center - 4e-6f;
  const BitsCheck check = checkBits(volumeOf(impliedBoundaries(grid_, measured)), occluders, tolerances);
  EXPECT_EQ(check.withinTolerance, 1u);
  EXPECT_EQ(check.mismatches, 1u);
}

TEST_F(VolumeCheckTest, OccludersAreEqualNearOrBeyond) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const std::vector<float> expected = {1.0f, 1.0f, 1.0f, kNone, kNone, 1.0f};
  const std::vector<float> measured = {1.0f, 1.000001f, 1.001f, kNone, 1.0f, NAN};
  const std::vector<float> tolerances(6, 3e-6f);
  const OccluderCheck check = checkOccluders(measured, expected, tolerances);
  EXPECT_EQ(check.columns, 6u);
  EXPECT_EQ(check.equal, 2u);
  EXPECT_EQ(check.withinTolerance, 1u);
  EXPECT_EQ(check.beyond, 3u);
  EXPECT_NEAR(check.largest, 1e-3f, 1e-6f);
}

}  // namespace
}  // namespace gnomon
