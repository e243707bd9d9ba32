// A volume that the GPU built is the one that its own source implies, and a defect at any of its stages shows.
#include "vsv/check/source_check.h"
#include "vsv_fixture.h"

namespace gnomon {
namespace {

using namespace test;

class SourceCheckTest : public gpu::GpuTest {
 protected:
  static VolumeSetup setup(const char* scene, VolumeSource source, VolumeFit fit) {
    return {.scene = scene,
            .size = {.alpha = 256, .theta = 256, .phi = 256},
            .source = source,
            .fit = fit,
            .cubeSide = 256,
            .pictureSide = 64};
  }
};

TEST_F(SourceCheckTest, TheBitsAreWhatTheSourceImplies) {
  for (const char* scene : {"contact", "atrium"}) {
    for (const VolumeSource source : {VolumeSource::Direct, VolumeSource::Resample}) {
      for (const VolumeFit fit : {VolumeFit::Frustum, VolumeFit::Full}) {
        const VolumeWorld world(device(), setup(scene, source, fit));
        const DenseVolume measured = denseOf(downloadBits(device(), world.volume));
        const SourceCheck check = checkSource(device(), world.volume, measured);
        const std::string what = std::string(scene) + " " + kVolumeSource.text(source) + " " + kVolumeFit.text(fit);
        EXPECT_EQ(check.sameMap.voxels, 256u * 256u * 256u);
        EXPECT_EQ(check.sameMap.mismatches, 0u) << what;
        EXPECT_EQ(check.sameOccluders.mismatches, 0u) << what;
        EXPECT_EQ(check.occluders.beyond, 0u) << what << " " << check.occluders.largest;
        EXPECT_GT(occludedCount(measured), 100000u) << what;
        if (isLavapipe()) {
          EXPECT_EQ(check.sameOccluders.withinTolerance, 0u) << what;
        }
        if (isLavapipe() && source == VolumeSource::Direct) {
          EXPECT_EQ(check.sameMap.withinTolerance, 0u) << what;
        }
        // Rounding concerns the few voxels whose centre an occluder all but touches.
        EXPECT_LT(check.sameMap.withinTolerance, check.sameMap.voxels / 100000) << what;
        EXPECT_LT(check.betweenTexels, columnCount(measured.grid) / 50) << what;
      }
    }
  }
}

TEST_F(SourceCheckTest, TheLayoutIsReadAsVolumeBitsReadsIt) {
  const VolumeWorld world(device(), setup("contact", VolumeSource::Direct, VolumeFit::Frustum));
  const VolumeBits bits = downloadBits(device(), world.volume);
  const DenseVolume dense = denseOf(bits);
  uint64_t wrong = 0;
  for (int alpha = 0; alpha < 256; ++alpha)
    for (int theta = 0; theta < 256; ++theta)
      for (int phi = 0; phi < 256; phi += 1 + (alpha + theta) % 3)
        wrong += dense.bit(alpha, theta, phi) != bits.bit(alpha, theta, phi);
  EXPECT_EQ(wrong, 0u);
}

// On the GPU's own data: a bit, one voxel everywhere, a row of the scan.
TEST_F(SourceCheckTest, DefectsOfTheBitsShow) {
  const VolumeWorld world(device(), setup("contact", VolumeSource::Resample, VolumeFit::Frustum));
  const DenseVolume measured = denseOf(downloadBits(device(), world.volume));
  DenseVolume flipped = measured;
  flipped.flip(100, 99, 98);
  EXPECT_EQ(checkSource(device(), world.volume, flipped).sameOccluders.mismatches, 1u);

  const ColumnBoundaries boundaries = boundariesOf(measured).boundaries;
  ColumnBoundaries off = boundaries;
  uint64_t movable = 0;
  for (int& first : off.first) {
    movable += first < 256;
    first = std::min(first + 1, 256);
  }
  // But where an occluder lies on a centre to within what fused arithmetic may round.
  const BitsCheck offByOne = checkSource(device(), world.volume, volumeOf(off)).sameOccluders;
  EXPECT_EQ(offByOne.mismatches + offByOne.withinTolerance, movable);
  EXPECT_LT(offByOne.withinTolerance, 10u);
  EXPECT_GT(movable, 1000u);

  DenseVolume skipped = measured;
  constexpr int kRow = 128;
  uint64_t lost = 0;  // what the row holds is not carried into it
  for (int theta = 0; theta < 256; ++theta)
    for (int phi = 0; phi < 256; ++phi)
      if (boundaries.first[columnIndex(measured.grid, theta, phi)] < kRow) {
        skipped.flip(kRow, theta, phi);
        ++lost;
      }
  EXPECT_EQ(checkSource(device(), world.volume, skipped).sameOccluders.mismatches, lost);
  EXPECT_GT(lost, 1000u);
}

// Exactly the volume of the column's own rays, but where rounding or a silhouette explains it.
TEST_F(SourceCheckTest, ADirectVolumeIsTheExactOneUpToRoundingAndSilhouettes) {
  for (const VolumeFit fit : {VolumeFit::Frustum, VolumeFit::Full}) {
    const VolumeWorld world(device(), setup("atrium", VolumeSource::Direct, fit));
    const FittedMap& columns = world.volume.fitted();
    const ExactVolume exact = traceColumns(world.seen.tracer(), columns.frame, columns.map.epipolar);
    const ColumnBoundaries measured = boundariesOf(denseOf(downloadBits(device(), world.volume))).boundaries;
    const BoundaryErrors errors =
        compareBoundaries(world.seen.tracer(), columns.frame, exact, measured, columnSource(world.volume), 1e-5);
    EXPECT_GT(errors.histogram[0], errors.columns * 99 / 100) << kVolumeFit.text(fit);
    uint64_t unexplained = 0;
    const BoundaryHistogram& resolution = errors.byCause[static_cast<size_t>(BoundaryCause::Resolution)];
    for (const uint64_t count : resolution) unexplained += count;
    EXPECT_LT(unexplained, errors.columns / 10000) << kVolumeFit.text(fit);
  }
}

// A full volume holds what the camera does not see, so the map it is looked up in must, too.
TEST_F(SourceCheckTest, AFullVolumeLooksBeyondWhatTheCameraSees) {
  VolumeSetup corner = setup("atrium", VolumeSource::Resample, VolumeFit::Full);
  corner.camera = lookAt("down", {1.0f, 2.0f, 0.5f}, {1.0f, 0.0f, 0.4f}, 0.5f);
  const VolumeWorld world(device(), corner);
  const FittedMap& columns = world.volume.fitted();
  const ExactVolume exact = traceColumns(world.seen.tracer(), columns.frame, columns.map.epipolar);
  const ColumnBoundaries measured = boundariesOf(denseOf(downloadBits(device(), world.volume))).boundaries;
  const BoundaryErrors errors =
      compareBoundaries(world.seen.tracer(), columns.frame, exact, measured, columnSource(world.volume), 1e-5);
  uint64_t outside = 0;
  for (const uint64_t count : errors.byCause[static_cast<size_t>(BoundaryCause::Outside)]) outside += count;
  EXPECT_LT(outside, errors.columns / 1000);
}

}  // namespace
}  // namespace gnomon
