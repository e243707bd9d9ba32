// Where the plot's marks stand, what is on its front, and that its labels stay apart.
#include "lab/page/report_plot.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

const std::vector<PlotItem> kItems = {{"none", 10.0, 0.4},      {"constant", 11.0, 0.002}, {"slope", 12.0, 0.001},
                                      {"cosine", 11.5, 0.05},   {"dual", 20.0, 0.0},       {"midpoint", 21.0, 0.0},
                                      {"adaptive", 12.0, 0.004}};

TEST(Plot, DearerIsFurtherRightAndWorseFurtherUp) {
  const Plot plot = layOutPlot(kItems, 980, 440);
  for (size_t a = 0; a < kItems.size(); ++a) {
    const PlotMark& mark = plot.marks[a];
    EXPECT_TRUE(mark.x > plot.left && mark.x < plot.right);
    EXPECT_TRUE(mark.y >= plot.top && mark.y < plot.bottom);
    for (size_t b = 0; b < kItems.size(); ++b) {
      EXPECT_EQ(kItems[a].costMs < kItems[b].costMs, mark.x < plot.marks[b].x);
      EXPECT_EQ(kItems[a].error<kItems[b].error, mark.y> plot.marks[b].y);
    }
  }
}

TEST(Plot, EachDecadeIsOneStepAndZeroLiesBelow) {
  const Plot plot = layOutPlot(kItems, 980, 440);
  ASSERT_EQ(plot.errorTicks.size(), 4u);  // 0.1 % to 100 %
  EXPECT_EQ(plot.errorTicks.front().text, "0.1 %");
  EXPECT_EQ(plot.errorTicks.back().text, "100 %");
  EXPECT_DOUBLE_EQ(plot.errorTicks[0].at - plot.errorTicks[1].at, plot.errorTicks[2].at - plot.errorTicks[3].at);
  EXPECT_DOUBLE_EQ(plot.marks[2].y, plot.errorTicks[0].at);  // slope: 0.001
  EXPECT_TRUE(plot.hasZero);
  EXPECT_GT(plot.zeroAt, plot.errorTicks.front().at + 10.0);
  EXPECT_DOUBLE_EQ(plot.marks[4].y, plot.zeroAt);
}

TEST(Plot, TheFrontHoldsWhatNothingCheaperMatches) {
  const Plot plot = layOutPlot(kItems, 980, 440);
  const std::vector<bool> expected = {true, true, true, false, true, false, false};
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(plot.marks[i].onFront, expected[i]) << kItems[i].label;
  EXPECT_EQ(std::count(plot.frontPath.begin(), plot.frontPath.end(), 'V'), 3);
}

TEST(Plot, NoiseOfTimesDoesNotDecideTheFront) {
  const std::vector<PlotItem> items = {{"worse", 10.0, 0.002}, {"better", 10.4, 0.001}, {"like it", 10.2, 0.001}};
  const auto front = [&](double noise) {
    const Plot plot = layOutPlot(items, 980, 440, CostAxis::Linear, ErrorText::Percent, noise);
    std::string names;
    for (size_t i = 0; i < items.size(); ++i)
      if (plot.marks[i].onFront) names += items[i].label + ";";
    return names;
  };
  EXPECT_EQ(front(0.0), "worse;like it;");
  EXPECT_EQ(front(0.05), "better;like it;");
}

TEST(Plot, OnALogarithmicAxisEqualFactorsAreEqualSteps) {
  const std::vector<PlotItem> items = {{"a", 1.0, 0.1}, {"b", 10.0, 0.01}, {"c", 1000.0, 0.001}};
  const Plot plot = layOutPlot(items, 980, 440, CostAxis::Logarithmic);
  EXPECT_NEAR(2.0 * (plot.marks[1].x - plot.marks[0].x), plot.marks[2].x - plot.marks[1].x, 1e-9);
  EXPECT_GT(plot.marks[0].x, plot.left);
  EXPECT_LT(plot.marks[2].x, plot.right);
  for (const PlotTick& tick : plot.costTicks)
    EXPECT_NEAR(tick.at, plot.xOfCost(std::stod(tick.text)), 1e-9) << tick.text;
  EXPECT_GE(plot.costTicks.size(), 4u);
}

TEST(DecadeSteps, AreOneTwoFiveOrPowersOfTenAlone) {
  EXPECT_EQ(decadeSteps(3.0, 60.0, 9), (std::vector<double>{5.0, 10.0, 20.0, 50.0}));
  EXPECT_EQ(decadeSteps(3.0, 6000.0, 5), (std::vector<double>{10.0, 100.0, 1000.0}));
}

TEST(Plot, LabelsStayApartAndWithinTheFrame) {
  for (const double width : {980.0, 368.0}) {
    std::vector<PlotItem> items = kItems;
    for (int i = 0; i < 53; ++i)
      items.push_back({"method " + std::to_string(i), 12.0 + 0.1 * (i % 7), 0.001 * (1 + i % 5)});
    const Plot plot = layOutPlot(items, width, 440);
    size_t labelled = 0;
    for (size_t a = 0; a < items.size(); ++a) {
      if (!plot.marks[a].labelled) continue;
      ++labelled;
      const auto span = [&](size_t i) {
        const PlotMark& mark = plot.marks[i];
        const double length = 6.6 * static_cast<double>(items[i].label.size());
        const double from = mark.anchor[0] == 's'   ? mark.labelX
                            : mark.anchor[0] == 'e' ? mark.labelX - length
                                                    : mark.labelX - length / 2;
        return std::pair(from, from + length);
      };
      EXPECT_GE(span(a).first, plot.left);
      EXPECT_LE(span(a).second, plot.right);
      for (size_t b = 0; b < a; ++b) {
        if (!plot.marks[b].labelled || std::abs(plot.marks[a].labelY - plot.marks[b].labelY) >= 13.0) continue;
        EXPECT_TRUE(span(a).first >= span(b).second || span(b).first >= span(a).second)
            << items[a].label << " on " << items[b].label;
      }
    }
    EXPECT_GE(labelled, 7u);
  }
}

TEST(Plot, OneItemAllZeroAndNoneAreFinite) {
  for (const std::vector<PlotItem>& items :
       {std::vector<PlotItem>{}, {{"a", 0.0, 0.0}}, {{"a", 5.0, 1.0}}, {{"a", 5.0, 1e-9}, {"b", 5.0, 1.0}}}) {
    const Plot plot = layOutPlot(items, 368, 400);
    for (const PlotMark& mark : plot.marks) {
      EXPECT_TRUE(std::isfinite(mark.x) && std::isfinite(mark.y));
      EXPECT_TRUE(mark.y >= plot.top && mark.y <= plot.bottom);
    }
    EXPECT_LE(plot.costTicks.size(), 12u);
    EXPECT_GE(plot.errorTicks.size(), 2u);
  }
}

TEST(RoundSteps, AreRound) {
  EXPECT_EQ(roundSteps(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(roundSteps(13.5, 29.5, 4), (std::vector<double>{15, 20, 25}));
}

}  // namespace
}  // namespace gnomon
