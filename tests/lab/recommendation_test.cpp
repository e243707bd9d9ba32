// What a comparison advises, how its table keeps to a width, and what ranks its rows.
#include "lab/compare/recommendation.h"
#include "lab/compare/table.h"
#include "lab/core/maps.h"

#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

Row rowOf(const char* bias, size_t acne, size_t edge, double rmse) {
  Row row{.map = "cube", .light = "lamp", .mapSide = 512, .layers = 6, .mapDimensions = "512", .bias = bias};
  row.scored = 10000;
  row.acne = acne;
  row.edgeLight = edge;
  row.agree = row.scored - acne - edge;
  row.rmse = rmse;
  row.mapBytes = 6 << 20;
  row.buildMs = 3.0;
  row.shadeMs = 2.0;
  row.frameMs = 9.0;
  row.params = {{"offset", 0.02}};
  row.units = {{"offset", "m"}};
  return row;
}

Comparison comparisonOf(std::vector<Row> rows) {
  Comparison comparison;
  comparison.rows = std::move(rows);
  return comparison;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Ranking, IsByTheErrorThroughTheFilterAskedFor) {
  Row a = rowOf("constant", 5, 90, 0.2), b = rowOf("slope", 20, 10, 0.1);
  EXPECT_EQ(ranked({b, a}).front().bias, "constant");
  for (Row* row : {&a, &b}) row->filter = "bilinear";
  EXPECT_EQ(ranked({a, b}).front().bias, "slope");
  EXPECT_EQ(rankingOf({a, rowOf("none", 0, 0, 0.0)}), Ranking::Rmse);
}

TEST(Ranking, KeepsTunedRowsApartFromTheOthers) {
  Row tuned = rowOf("slope", 1, 0, 0.1);
  tuned.tuning = Tuning{};
  const std::vector<Row> rows = ranked({rowOf("constant", 9, 0, 0.1), tuned, rowOf("dual", 5, 0, 0.1)});
  const BestRows best = bestOf(rows);
  EXPECT_EQ(best.untuned->bias, "dual");
  EXPECT_EQ(best.tuned->bias, "slope");
  EXPECT_EQ(bestOf({}).untuned, nullptr);
}

TEST(Recommendation, SaysWhatToUseAndHowGoodItStaysElsewhere) {
  Row best = rowOf("dual", 5, 20, 0.05);
  best.elsewhere = Elsewhere{.otherCamera = CameraError{{0.002, 0.005, std::nullopt}, "aside"},
                             .otherMapSize = MapSizeError{{0.01, 0.02, std::nullopt}, 256}};
  const std::vector<std::string> lines = linesOf(recommendation(comparisonOf({rowOf("constant", 9, 0, 0.1), best})));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0],
            "Use dual on a cube map of 512, at its default (offset 0.02 m): bias error 0.05%, all wrong 0.25%; 9 ms a "
            "frame (map 3, shading 2), 6 MiB");
  EXPECT_EQ(lines[1],
            "  elsewhere: from camera 'aside' bias error 0.2%, all wrong 0.5%; on a map of 256 bias error 1%, all "
            "wrong 2%");
}

TEST(Recommendation, IsSilentWhereThereIsNothingToChoose) {
  EXPECT_EQ(recommendation(comparisonOf({})), "");
  EXPECT_EQ(recommendation(comparisonOf({rowOf("dual", 5, 20, 0.05)})), "");
}

// The exact shadow's own margin decides 4 pixels: what differs by no more is as good, and may be cheaper.
TEST(Recommendation, NamesWhatTheExactShadowCannotTellApart) {
  Row best = rowOf("witness", 5, 20, 0.05), near = rowOf("slope", 9, 20, 0.05), far = rowOf("constant", 10, 20, 0.05);
  Row edgy = rowOf("dual", 5, 25, 0.05);
  near.frameMs = 4.0;
  Comparison comparison = comparisonOf({best, near, far, edgy});
  comparison.truths = {
      {.map = "cube", .light = {.name = "lamp"}, .scored = 10000, .lit = 5000, .marginFlipsDouble = 4}};
  EXPECT_EQ(linesOf(recommendation(comparison)).back(),
            "  as good, within the 4 pixels that the exact shadow cannot tell: slope on a cube map (4 ms)");
  comparison.truths[0].marginFlipsDouble = 3;
  EXPECT_EQ(linesOf(recommendation(comparison)).size(), 1u);
}

TEST(Recommendation, GivesNoneWhereTheLightLightsNothing) {
  Comparison comparison = comparisonOf({rowOf("dual", 0, 0, 0.0), rowOf("constant", 0, 0, 0.0)});
  comparison.truths = {{.map = "cube", .light = {.name = "lamp"}, .scored = 10000, .lit = 0}};
  EXPECT_TRUE(recommendation(comparison).starts_with("No advice: all that the camera sees lies in shadow"));
}

TEST(Recommendation, TellsTheBestTunedRowApart) {
  Row tuned = rowOf("slope", 1, 20, 0.05), given = rowOf("constant", 7, 0, 0.1);
  tuned.tuning = Tuning{.knob = "offset", .otherMapSize = MapSizeTransfer{{0.04, 0.01}, 256}};
  given.isGiven = true;
  const std::vector<std::string> lines = linesOf(recommendation(comparisonOf({given, tuned})));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[0].starts_with("Use constant on a cube map of 512, as given")) << lines[0];
  EXPECT_TRUE(lines[1].starts_with("Tuned for this very picture: slope on a cube map of 512 (offset 0.02 m)"));
  EXPECT_EQ(lines[2], "  elsewhere: on a map of 256 bias error 4% (best there 1%)");
}

TEST(Recommendation, OfSeveralLightsTellsTheirRange) {
  Row sum = rowOf("dual", 50, 0, 0.1), first = rowOf("dual", 10, 0, 0.1), second = rowOf("dual", 90, 0, 0.1);
  sum.light = "all";
  sum.isSum = true;
  second.light = "moon";
  Row other = sum;
  other.bias = "constant";
  other.acne = 70;
  const std::vector<std::string> lines = linesOf(recommendation(comparisonOf({first, second, sum, other})));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1], "  elsewhere: over 2 lights bias errors of 0.1% to 0.9%");
}

TEST(Table, KeepsToTheWidthAndLosesTheLeastNeededColumnsFirst) {
  Comparison comparison = comparisonOf({rowOf("adaptive-clamped", 5, 20, 0.05), rowOf("dual", 50, 20, 0.05)});
  comparison.rows[0].params.push_back({"factor", 2.0});
  comparison.rows[0].params.push_back({"texels", 1.5});
  const std::string wide = comparisonTable(comparison, {.wide = true, .width = 60});
  for (const char* head : {"agree", "edge_sh", "build ms", "all wrong", "bias error"})
    EXPECT_NE(wide.find(head), std::string::npos) << head;
  const std::string usual = comparisonTable(comparison);
  for (const char* head : {"bias error", "all wrong", "edge", "frame ms", "rmse"})
    EXPECT_NE(usual.find(head), std::string::npos) << head;
  for (const char* head : {"agree", "edge_sh", "build ms", "filter", "uncovered", "flip"})
    EXPECT_EQ(usual.find(head), std::string::npos) << head;
  for (const size_t width : {size_t{80}, size_t{90}, size_t{100}, size_t{120}}) {
    const std::string table = comparisonTable(comparison, {.width = width});
    for (const std::string& line : linesOf(table)) EXPECT_LE(line.size(), width) << line;
    for (const char* head : {"bias error", "all wrong", "acne", "leak"})
      EXPECT_NE(table.find(head), std::string::npos) << width << head;
  }
  EXPECT_EQ(comparisonTable(comparison, {.width = 80}).find("rmse"), std::string::npos);
  comparison.rows[0].filter = comparison.rows[1].filter = "bilinear";
  EXPECT_NE(comparisonTable(comparison, {.width = 80}).find("rmse"), std::string::npos);  // what it is ranked by
}

}  // namespace
}  // namespace gnomon
