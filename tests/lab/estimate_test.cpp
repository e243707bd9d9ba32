// What a dry run of a sweep makes of the few cases that it measures.
#include "lab/sweep/estimate.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

const CaseShape kCube{"cube", 64, 2}, kLargeCube{"cube", 512, 2}, kSpot{"spot", 64, 4};

TEST(SweepEstimate, WhatMayHaveCompiledIsMeasuredAgain) {
  const TriedCase first{kCube, 10.0};
  EXPECT_TRUE(mayHaveCompiled(first, {}));
  EXPECT_FALSE(mayHaveCompiled({kCube, 1.1}, {{kCube, 1.0}}));
  EXPECT_TRUE(mayHaveCompiled({kLargeCube, 5.0}, {{kCube, 1.0}}));
  EXPECT_TRUE(mayHaveCompiled({kSpot, 1.0}, {{kCube, 1.0}}));
}

TEST(SweepEstimate, EachCaseIsAsThoseOfItsMapAndSize) {
  const std::vector<TriedCase> tried = {{kCube, 1.0}, {kCube, 3.0}, {kLargeCube, 8.0}};
  EXPECT_DOUBLE_EQ(extrapolatedSeconds(tried, {kCube, kCube, kLargeCube}), 2.0 + 2.0 + 8.0);
  // Of another size: as those of its map; with half of the rows, half of it.
  EXPECT_DOUBLE_EQ(extrapolatedSeconds(tried, {{"cube", 128, 1}}), 2.0);
  // Of another map: by rows as all, and what comes once comes for it, too.
  EXPECT_DOUBLE_EQ(extrapolatedSeconds(tried, {kCube, kSpot}), 2.0 + 8.0);
  EXPECT_DOUBLE_EQ(extrapolatedSeconds({{kCube, 1.0, 5.0}}, {kCube, kCube, kSpot}), 1.0 + 1.0 + 2.0 + 2 * 5.0);
}

TEST(SweepEstimate, OfNothingNothing) {
  EXPECT_EQ(extrapolatedSeconds({}, {}), 0.0);
  EXPECT_EQ(extrapolatedSeconds({}, {kCube}), 0.0);
}

}  // namespace
}  // namespace gnomon
