// The exact volume against closed forms, and why a boundary is off where a source is known to err.
#include "vsv/check/exact_volume.h"
#include "tests/truth/scenes_by_hand.h"
#include "truth/visibility.h"
#include "volumes_by_hand.h"
#include "vsv/check/volume_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace gnomon {
namespace {

using namespace test;

glsl::LightFrame levelFrame() {
  return {.originW = {0, 2, 0}, .rightW = {1, 0, 0}, .upW = {0, 1, 0}, .backW = {0, 0, 1}};
}

uint64_t sum(const BoundaryHistogram& histogram) {
  return std::accumulate(histogram.begin(), histogram.end(), uint64_t{0});
}
uint64_t countOf(const BoundaryErrors& errors, BoundaryCause cause) {
  return sum(errors.byCause[static_cast<size_t>(cause)]);
}

// The light 2 m above a floor: the ray down by the cosine c meets it after 2 / c metres, and alpha there is
// the angle at the eye, from dot and cross products.
TEST(ExactVolume, AFloorIsMetWhereTheClosedFormSays) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 4000.0);
  const Tracer tracer(scene);
  const glsl::LightFrame frame = levelFrame();
  const glsl::EpipolarGrid grid = fullGrid(512, 128, 128);
  const ExactVolume exact = traceColumns(tracer, frame, grid);
  const glm::dvec3 lightW(0, 2, 0), eyeW(0, 2, grid.eyeDistance);
  size_t hits = 0, wrongFirst = 0;
  for (int theta = 0; theta < grid.thetaCount; ++theta) {
    for (int phi = 0; phi < grid.phiCount; ++phi) {
      const RayD ray = columnRayW(frame, grid, theta, phi);
      const size_t c = columnIndex(grid, theta, phi);
      const double r = -2.0 / ray.dir.y;
      const glm::dvec3 pointW = lightW + ray.dir * r;
      if (ray.dir.y >= 0.0) {
        EXPECT_TRUE(std::isinf(exact.alphaOccluder[c]));
        EXPECT_EQ(exact.boundaries.first[c], grid.alphaCount);
        continue;
      }
      if (std::abs(pointW.x) > 3999.0 || std::abs(pointW.z) > 3999.0) continue;
      ++hits;
      const glm::dvec3 a = lightW - eyeW, b = pointW - eyeW;
      const double alpha = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
      ASSERT_NEAR(exact.alphaOccluder[c], alpha, 1e-9);
      ASSERT_NEAR(exact.distance[c] / r, 1.0, 1e-9);
      int first = 0;
      while (first < grid.alphaCount && !(grid.alphaLower + (first + 0.5) * grid.alphaStep > alpha)) ++first;
      wrongFirst += exact.boundaries.first[c] != first;
    }
  }
  EXPECT_EQ(wrongFirst, 0u);
  EXPECT_GT(hits, columnCount(grid) * 2 / 5);
}

class BoundaryErrorsTest : public ::testing::Test {
 protected:
  BoundaryErrorsTest() {
    addFloor(scene_, 0.0, 100.0);
    addQuad(scene_, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});  // one metre below the light
    tracer_ = std::make_unique<Tracer>(scene_);
    exact_ = traceColumns(*tracer_, frame_, grid_);
  }

  // As a coarse map would: every fourth column each way stands for its neighbours.
  RayD coarseRay(int theta, int phi) const { return columnRayW(frame_, grid_, theta / 4 * 4 + 2, phi / 4 * 4 + 2); }
  ColumnBoundaries coarseBoundaries() const {
    ColumnBoundaries coarse = exact_.boundaries;
    std::vector<float> occluders(columnCount(grid_));
    for (int theta = 0; theta < grid_.thetaCount; ++theta) {
      for (int phi = 0; phi < grid_.phiCount; ++phi) {
        const size_t from = columnIndex(grid_, theta / 4 * 4 + 2, phi / 4 * 4 + 2);
        const double r = exact_.distance[from];
        const double angle = grid_.phiLower + (phi + 0.5) * grid_.phiStep;
        occluders[columnIndex(grid_, theta, phi)] =
            std::isinf(r)
                ? HUGE_VALF
                : static_cast<float>(std::atan2(r * std::sin(angle), grid_.eyeDistance - r * std::cos(angle)));
      }
    }
    return impliedBoundaries(grid_, occluders);
  }
  BoundaryErrors compare(const ColumnBoundaries& measured, const ColumnSource& source) const {
    return compareBoundaries(*tracer_, frame_, exact_, measured, source, endMargin(scene_));
  }

  Scene scene_ = emptyScene();
  const glsl::LightFrame frame_ = levelFrame();
  const glsl::EpipolarGrid grid_ = fullGrid(256, 128, 128);
  std::unique_ptr<Tracer> tracer_;
  ExactVolume exact_;
};

TEST_F(BoundaryErrorsTest, TheExactVolumeHasNone) {
  const BoundaryErrors errors = compare(exact_.boundaries, {});
  EXPECT_EQ(errors.columns, columnCount(grid_));
  EXPECT_EQ(errors.histogram[0], errors.columns);
  EXPECT_EQ(errors.tooDark + errors.tooLight, 0u);
}

TEST_F(BoundaryErrorsTest, TheHistogramCountsColumnsByHowFarTheyAreOff) {
  ColumnBoundaries measured = exact_.boundaries;
  std::vector<size_t> movable;
  for (size_t c = 0; c < measured.first.size() && movable.size() < 8; ++c)
    if (measured.first[c] > 40 && measured.first[c] < 200) movable.push_back(c);
  ASSERT_EQ(movable.size(), 8u);
  const std::array<int, 8> off = {1, -1, 2, -3, 4, 7, -8, 20};
  for (size_t i = 0; i < off.size(); ++i) measured.first[movable[i]] += off[i];
  const BoundaryErrors errors = compare(measured, {});
  EXPECT_EQ(errors.histogram[0], errors.columns - 8);
  EXPECT_EQ(errors.histogram[1], 2u);  // 1
  EXPECT_EQ(errors.histogram[2], 2u);  // 2-3
  EXPECT_EQ(errors.histogram[3], 2u);  // 4-7
  EXPECT_EQ(errors.histogram[4], 1u);  // 8-15
  EXPECT_EQ(errors.histogram[5], 1u);  // 16-31
  EXPECT_EQ(bucketStart(5), 16);
  EXPECT_EQ(errors.tooDark, 1u + 3u + 8u);
  EXPECT_EQ(errors.tooLight, 1u + 2u + 4u + 7u + 20u);
}

// A coarse source errs on the plain surfaces by its resolution, and across the quad's rim by a silhouette:
// told apart as the instances that the two rays hit say.
TEST_F(BoundaryErrorsTest, SilhouettesAndResolutionAreToldApart) {
  const ColumnBoundaries measured = coarseBoundaries();
  uint64_t silhouettes = 0, resolution = 0;
  for (int theta = 0; theta < grid_.thetaCount; ++theta) {
    for (int phi = 0; phi < grid_.phiCount; ++phi) {
      const size_t c = columnIndex(grid_, theta, phi);
      if (measured.first[c] == exact_.boundaries.first[c]) continue;
      const auto own = tracer_->firstHit(columnRayW(frame_, grid_, theta, phi));
      const auto other = tracer_->firstHit(coarseRay(theta, phi));
      const bool onePiece =
          own.has_value() == other.has_value() && (!own || own->primitive.instance == other->primitive.instance);
      ++(onePiece ? resolution : silhouettes);
    }
  }
  const BoundaryErrors errors = compare(measured, {.rayW = [&](int theta, int phi) { return coarseRay(theta, phi); }});
  EXPECT_EQ(countOf(errors, BoundaryCause::Silhouette), silhouettes);
  EXPECT_EQ(countOf(errors, BoundaryCause::Resolution), resolution);
  EXPECT_EQ(sum(errors.histogram), errors.columns);
  EXPECT_GT(silhouettes, 100u);
  EXPECT_GT(resolution, 100u);
}

TEST_F(BoundaryErrorsTest, WhatASourceDoesNotCoverIsCountedApart) {
  ColumnBoundaries blind = exact_.boundaries;
  uint64_t floorColumns = 0;
  for (size_t c = 0; c < blind.first.size(); ++c) {
    if (std::isinf(exact_.distance[c]) || blind.first[c] == grid_.alphaCount) continue;
    const auto phi = static_cast<int>(c / grid_.thetaCount), theta = static_cast<int>(c % grid_.thetaCount);
    const RayD ray = columnRayW(frame_, grid_, theta, phi);
    if ((ray.origin + ray.dir * exact_.distance[c]).y > 0.5) continue;
    blind.first[c] = grid_.alphaCount;
    ++floorColumns;
  }
  const BoundaryErrors errors = compare(blind, {.covers = [](const glm::dvec3& posW) { return posW.y > 0.5; }});
  EXPECT_EQ(countOf(errors, BoundaryCause::Outside), floorColumns);
  EXPECT_EQ(errors.histogram[0], errors.columns - floorColumns);
  EXPECT_GT(floorColumns, 1000u);
}

TEST_F(BoundaryErrorsTest, ABoundaryAtACentreWithinTheToleranceIsRounding) {
  const size_t c = columnIndex(grid_, 64, 20);
  exact_.alphaOccluder[c] = grid_.alphaLower + 100.5 * grid_.alphaStep - 1e-7;
  exact_.boundaries.first[c] = 100;
  ColumnBoundaries measured = exact_.boundaries;
  measured.first[c] = 101;
  const ColumnSource source{.rounding = [](double, int) { return 2e-7; }};
  EXPECT_EQ(countOf(compare(measured, source), BoundaryCause::Rounding), 1u);
  measured.first[c] = 99;  // no rounding of 2e-7 reaches the centre of voxel 99
  EXPECT_EQ(countOf(compare(measured, source), BoundaryCause::Rounding), 0u);
  measured.first[c] = 102;
  EXPECT_EQ(countOf(compare(measured, source), BoundaryCause::Rounding), 0u);
}

// A source that decides by the column's own ray: what is off beside the quad's rim is a silhouette, and what
// is off elsewhere has no excuse.
TEST_F(BoundaryErrorsTest, WithoutARayOfItsOwnASilhouetteIsWhereOneIsTouched) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 100.0);
  const RayD rim = columnRayW(frame_, grid_, 5, 40), plain = columnRayW(frame_, grid_, 120, 40);
  ASSERT_LT(rim.dir.y, 0.0);
  const glm::dvec3 p = rim.origin + rim.dir * (-1.0 / rim.dir.y);  // at height 1
  addQuad(scene, {p.x + 1e-8, 1, p.z - 1}, {p.x + 1, 1, p.z - 1}, {p.x + 1, 1, p.z + 1}, {p.x + 1e-8, 1, p.z + 1});
  ASSERT_LT(plain.dir.y, 0.0);
  const Tracer tracer(scene);
  const ExactVolume exact = traceColumns(tracer, frame_, grid_);
  ColumnBoundaries measured = exact.boundaries;
  for (const int theta : {5, 120}) {
    int& first = measured.first[columnIndex(grid_, theta, 40)];
    first = first > 20 ? first - 20 : first + 20;
  }
  const BoundaryErrors errors = compareBoundaries(tracer, frame_, exact, measured, {}, endMargin(scene));
  EXPECT_EQ(countOf(errors, BoundaryCause::Silhouette), 1u);
  EXPECT_EQ(countOf(errors, BoundaryCause::Resolution), 1u);
}

}  // namespace
}  // namespace gnomon
