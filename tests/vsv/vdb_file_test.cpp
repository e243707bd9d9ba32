// A .vdb file, opened by OpenVDB itself: voxels, transforms, metadata; and whole or absent.
#include "vsv/check/vdb_file.h"
#include "base/error.h"
#include "tests/base/file_limit.h"
#include "tests/base/temporary_folder.h"
#include "volumes_by_hand.h"

#include <cmath>

#include <openvdb/openvdb.h>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

using namespace test;
namespace fs = std::filesystem;

class VdbFileTest : public ::testing::Test {
 protected:
  VdbFileTest() { openvdb::initialize(); }

  VdbSummary write(const fs::path& path, double voxel = 0.25) const {
    VdbOptions options{.source = "by hand", .command = "gnomon vsv x", .voxelMetres = voxel};
    options.boundsW = {{-4.0f, -3.0f, -2.0f}, {7.0f, 8.0f, 9.0f}};
    options.frame = frame_;
    return writeVdb(path, VolumeGrid(volume_), volume_, options);
  }
  static openvdb::GridPtrVec read(const fs::path& path) {
    openvdb::io::File file(path.string());
    file.open();
    return *file.getGrids();
  }

  const glsl::EpipolarGrid grid_ = fullGrid(96, 72, 128);
  const glsl::LightFrame frame_ = tiltedFrame();
  const DenseVolume volume_ = volumeOf(impliedBoundaries(grid_, smoothOccluders(grid_)));
  const TemporaryFolder temporary_;
  const fs::path path_ = temporary_.path() / "v.vdb";
};

TEST_F(VdbFileTest, TheEpipolarMaskComesBackVoxelForVoxel) {
  write(path_);
  const auto mask = openvdb::gridPtrCast<openvdb::MaskGrid>(openvdb::findGridByName(read(path_), "shadow_epipolar"));
  ASSERT_TRUE(mask);
  EXPECT_EQ(mask->activeVoxelCount(), occludedCount(volume_));
  uint64_t wrong = 0;
  const auto accessor = mask->getConstAccessor();
  for (int alpha = 0; alpha < grid_.alphaCount; ++alpha)
    for (int theta = 0; theta < grid_.thetaCount; ++theta)
      for (int phi = 0; phi < grid_.phiCount; ++phi)
        if (accessor.isValueOn({alpha, theta, phi}) != volume_.bit(alpha, theta, phi)) ++wrong;
  EXPECT_EQ(wrong, 0u);
  const openvdb::Vec3d radians = mask->indexToWorld(openvdb::Coord(10, 20, 30));
  EXPECT_NEAR(radians.x(), glsl::alphaCenter(grid_, 10), 1e-6);
  EXPECT_NEAR(radians.y(), grid_.thetaLower + 20.5 * grid_.thetaStep, 1e-6);
  EXPECT_NEAR(radians.z(), grid_.phiLower + 30.5 * grid_.phiStep, 1e-6);
}

// Each point of the density against the bits, by formulas written out here and not by those of the writer.
TEST_F(VdbFileTest, TheDensityIsOneWhereAPointOfTheWorldLiesInShadow) {
  const VdbSummary summary = write(path_);
  const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(openvdb::findGridByName(read(path_), "density"));
  ASSERT_TRUE(density);
  EXPECT_EQ(density->getGridClass(), openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(density->voxelSize(), openvdb::Vec3d(0.25));
  EXPECT_EQ(density->activeVoxelCount(), summary.densityVoxels);
  const auto accessor = density->getConstAccessor();
  uint64_t shadowed = 0, wrong = 0, tested = 0;
  for (int x = -20; x <= 32; ++x)
    for (int y = -16; y <= 36; ++y)
      for (int z = -12; z <= 40; ++z) {
        const openvdb::Vec3d w = density->indexToWorld(openvdb::Coord(x, y, z));
        const bool inBox =
            w.x() >= -4.0 && w.x() <= 7.0 && w.y() >= -3.0 && w.y() <= 8.0 && w.z() >= -2.0 && w.z() <= 9.0;
        const glm::dvec3 p = glm::dvec3(w.x(), w.y(), w.z()) - glm::dvec3(frame_.originW);
        const glm::dvec3 posL(glm::dot(p, glm::dvec3(frame_.rightW)), glm::dot(p, glm::dvec3(frame_.upW)),
                              glm::dot(p, glm::dvec3(frame_.backW)));
        const double aside = std::hypot(posL.x, posL.y);
        const double steps[3] = {(std::atan2(aside, grid_.eyeDistance - posL.z) - grid_.alphaLower) / grid_.alphaStep,
                                 (std::atan2(posL.x, posL.y) - grid_.thetaLower) / grid_.thetaStep,
                                 (std::atan2(aside, posL.z) - grid_.phiLower) / grid_.phiStep};
        bool nearSide = false;  // of a voxel: rounding decides
        for (const double s : steps) nearSide = nearSide || std::abs(s - std::round(s)) < 1e-3;
        if (nearSide) continue;
        const bool inside = steps[0] >= 0 && steps[0] < grid_.alphaCount && steps[1] >= 0 &&
                            steps[1] < grid_.thetaCount && steps[2] >= 0 && steps[2] < grid_.phiCount;
        const bool expected =
            inBox && inside &&
            volume_.bit(static_cast<int>(steps[0]), static_cast<int>(steps[1]), static_cast<int>(steps[2]));
        ++tested;
        shadowed += expected;
        if (accessor.getValue({x, y, z}) != (expected ? 1.0f : 0.0f)) ++wrong;
        if (accessor.isValueOn({x, y, z}) != expected) ++wrong;
      }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(shadowed, 10000u);
  EXPECT_GT(tested - shadowed, 10000u);
}

TEST_F(VdbFileTest, BothGridsSayWhatMadeThem) {
  write(path_);
  openvdb::io::File file(path_.string());
  file.open();
  std::vector<openvdb::MetaMap::Ptr> carriers = {file.getMetadata()};
  const openvdb::GridPtrVecPtr grids = file.getGrids();
  for (const openvdb::GridBase::Ptr& grid : *grids) carriers.push_back(grid);
  ASSERT_EQ(carriers.size(), 3u);
  const glm::vec3 eyeW = frame_.originW + frame_.backW * grid_.eyeDistance;
  for (const openvdb::MetaMap::Ptr& meta : carriers) {
    EXPECT_EQ(meta->metaValue<openvdb::Vec3d>("gnomon_light"), openvdb::Vec3d(1.0, 2.0, 3.0));
    EXPECT_EQ(meta->metaValue<openvdb::Vec3d>("gnomon_eye"), openvdb::Vec3d(eyeW.x, eyeW.y, eyeW.z));
    EXPECT_EQ(meta->metaValue<openvdb::Vec3d>("gnomon_lower").x(), grid_.alphaLower);
    EXPECT_EQ(meta->metaValue<openvdb::Vec3d>("gnomon_step").y(), grid_.thetaStep);
    EXPECT_EQ(meta->metaValue<openvdb::Vec3i>("gnomon_counts"), openvdb::Vec3i(96, 72, 128));
    EXPECT_EQ(meta->metaValue<std::string>("gnomon_source"), "by hand");
    EXPECT_EQ(meta->metaValue<std::string>("gnomon_command"), "gnomon vsv x");
  }
}

TEST_F(VdbFileTest, TheVoxelSizeIsTheMeanVoxelsWhereNoneIsGiven) {
  const Bounds bounds{{-4.0f, -3.0f, -2.0f}, {7.0f, 8.0f, 9.0f}};
  const double voxel = meanVoxel(grid_, frame_, bounds);
  EXPECT_NEAR(write(path_, 0.0).voxelMetres, voxel, 1e-12);
  // The full volume covers most of the bounds: what is left out lies beyond its ends of alpha and phi.
  const double whole = std::cbrt(11.0 * 11.0 * 11.0 / static_cast<double>(voxelCount(grid_)));
  EXPECT_LE(voxel, whole);
  EXPECT_GT(voxel, 0.8 * whole);
}

TEST_F(VdbFileTest, AVoxelSizeThatAsksForTooMuchIsRefusedWithOneThatFits) {
  try {
    write(path_, 1e-4);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("--vdb-voxel 0.0001"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(fs::is_empty(temporary_.path()));
}

TEST_F(VdbFileTest, APathThatCannotBeWrittenIsNamedAndNothingIsLeft) {
  fs::create_directory(path_);
  try {
    write(path_);
    FAIL();
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("v.vdb"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
  EXPECT_THROW(write("/proc/nowhere/v.vdb"), WorldError);
  EXPECT_EQ(std::distance(fs::directory_iterator(temporary_.path()), fs::directory_iterator()), 1);
}

TEST_F(VdbFileTest, TheSameVolumeGivesTheSameBytes) {
  write(path_);
  const std::string first = readFile(path_);
  write(path_);
  EXPECT_TRUE(readFile(path_) == first);
}

TEST_F(VdbFileTest, AFullDiskLeavesTheOldFileWhereverItIsFull) {
  test::expectWholeOrOld<WorldError>(path_, [&] { write(path_); });
}

}  // namespace
}  // namespace gnomon
