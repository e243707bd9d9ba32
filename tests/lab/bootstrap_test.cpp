// Intervals that must hold the truth as often as they say, and statistics with known answers.
#include "lab/statistics/bootstrap.h"

#include <random>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(Bootstrap, QuantilesOfWholeAndWeightedValuesAgree) {
  EXPECT_DOUBLE_EQ(quantile({1, 2, 3, 4, 5}, 0.5), 3.0);
  EXPECT_DOUBLE_EQ(quantile({0, 10}, 0.95), 9.5);
  // A group a value: a draw in which each is drawn once gives the whole's median; so the interval holds it.
  std::vector<GroupedValue> values;
  for (size_t i = 0; i < 101; ++i) values.push_back({static_cast<double>(i), i});
  const Estimates estimates = estimatesOf(values, Resamples(101, 1000, 1));
  EXPECT_EQ(estimates.count, 101u);
  EXPECT_DOUBLE_EQ(estimates.mean.value, 50.0);
  EXPECT_DOUBLE_EQ(estimates.median.value, 50.0);
  EXPECT_DOUBLE_EQ(estimates.p95.value, 95.0);
  EXPECT_DOUBLE_EQ(estimates.worst, 100.0);
  // Of a mean of 101 values evenly over 0..100 the standard error is 2.90.
  EXPECT_NEAR(estimates.mean.interval->upper - estimates.mean.interval->lower, 2 * 1.96 * 2.90, 1.0);
}

TEST(Bootstrap, GroupsThatAreAlikeGiveWiderIntervalsThanSingleCases) {
  // Five scenes, each with a hundred cases of the same error.
  std::vector<GroupedValue> byScene, byCase;
  for (size_t i = 0; i < 500; ++i) {
    byScene.push_back({static_cast<double>(i / 100), i / 100});
    byCase.push_back({static_cast<double>(i / 100), i});
  }
  const Estimate scenes = meanOf(byScene, Resamples(5, 1000, 1)), cases = meanOf(byCase, Resamples(500, 1000, 1));
  EXPECT_EQ(scenes.value, cases.value);
  EXPECT_GT(scenes.interval->upper - scenes.interval->lower, 5 * (cases.interval->upper - cases.interval->lower));
}

TEST(Bootstrap, IntervalsHoldTheTrueMeanAboutAsOftenAsTheySay) {
  std::mt19937 random(7);
  std::normal_distribution<double> group(0.0, 1.0), single(0.0, 0.2);
  int held = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<GroupedValue> values;
    for (size_t g = 0; g < 20; ++g) {
      const double middle = group(random);
      for (int i = 0; i < 10; ++i) values.push_back({middle + single(random), g});
    }
    const Estimate mean = meanOf(values, Resamples(20, 300, 1));
    held += mean.interval->lower <= 0.0 && 0.0 <= mean.interval->upper ? 1 : 0;
  }
  // Percentile intervals of twenty groups hold some 92 to 93 %.
  EXPECT_GT(held, 0.87 * kTrials);
  EXPECT_LT(held, 0.99 * kTrials);
}

TEST(Bootstrap, OneGroupSaysNothingOfOthers) {
  const Estimates estimates = estimatesOf({{1.0, 0}, {2.0, 0}}, Resamples(3, 100, 1));
  EXPECT_FALSE(estimates.mean.interval);
  EXPECT_FALSE(estimates.median.interval);
}

TEST(Bootstrap, TheSameSeedDrawsTheSame) {
  const Resamples a(7, 10, 3), b(7, 10, 3), c(7, 10, 4);
  bool differs = false;
  for (size_t r = 0; r < 10; ++r) {
    size_t drawn = 0;
    for (size_t g = 0; g < 7; ++g) {
      EXPECT_EQ(a.weights(r)[g], b.weights(r)[g]);
      differs = differs || a.weights(r)[g] != c.weights(r)[g];
      drawn += a.weights(r)[g];
    }
    EXPECT_EQ(drawn, 7u);
  }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace gnomon
