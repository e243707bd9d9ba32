#include "view/moving_detail.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

constexpr double kBudget = 50.0;  // ms

// A machine on which full maps and pixels take so long.
struct Machine {
  double mapMs = 0.0, pixelMs = 0.0, fixedMs = 0.0;
  PictureTimes timesOf(const MovingDetail& detail) const {
    double maps = mapMs;
    for (int i = 0; i < detail.halvings(); ++i) maps /= 4.0;
    return {.all = fixedMs + maps + pixelMs * detail.share() * detail.share(), .maps = maps};
  }
};

MovingDetail settled(const Machine& machine) {
  MovingDetail detail;
  detail.begin(kBudget, machine.timesOf(detail));
  for (int i = 0; i < 500; ++i) detail.follow(kBudget, machine.timesOf(detail));
  return detail;
}

TEST(MovingDetail, WhatFitsIsDrawnInFull) {
  const MovingDetail detail = settled({.mapMs = 20.0, .pixelMs = 20.0});
  EXPECT_EQ(detail.share(), 1.0);
  EXPECT_EQ(detail.halvings(), 0);
}

// Whichever takes the time is made smaller, and not the other.
TEST(MovingDetail, MapsOrPixelsGiveWay) {
  const MovingDetail ofMaps = settled({.mapMs = 120.0, .pixelMs = 10.0});
  EXPECT_EQ(ofMaps.share(), 1.0);
  EXPECT_EQ(ofMaps.halvings(), 1);
  const MovingDetail ofPixels = settled({.mapMs = 10.0, .pixelMs = 120.0});
  EXPECT_LT(ofPixels.share(), 0.75);
  EXPECT_EQ(ofPixels.halvings(), 0);
}

// The budget holds where it can be held.
TEST(MovingDetail, TheBudgetHolds) {
  for (const Machine& machine : {Machine{100, 100, 5}, Machine{400, 20, 5}, Machine{20, 400, 5}, Machine{300, 300, 10}})
    EXPECT_LE(machine.timesOf(settled(machine)).all, 1.15 * kBudget) << machine.mapMs << " " << machine.pixelMs;
}

// What takes its time whatever is drawn ends at the least, and does not go to and fro.
TEST(MovingDetail, ThereIsALeast) {
  const MovingDetail detail = settled({.mapMs = 10.0, .pixelMs = 10.0, .fixedMs = 500.0});
  EXPECT_EQ(detail.share(), 0.25);
  EXPECT_EQ(detail.halvings(), 3);
}

// More is drawn again when the machine is faster, but not at once.
TEST(MovingDetail, MoreIsTriedAgain) {
  MovingDetail detail = settled({.mapMs = 200.0, .pixelMs = 200.0});
  const Machine fast{.mapMs = 5.0, .pixelMs = 5.0};
  for (int i = 0; i < 500; ++i) detail.follow(kBudget, fast.timesOf(detail));
  EXPECT_EQ(detail.share(), 1.0);
  EXPECT_EQ(detail.halvings(), 0);
  detail.follow(kBudget, {.all = 200.0, .maps = 100.0});
  const double less = detail.share();
  detail.follow(kBudget, {.all = 1.0, .maps = 0.5});
  EXPECT_EQ(detail.share(), less);
}

}  // namespace
}  // namespace gnomon
