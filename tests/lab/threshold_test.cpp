// --fail-if: what is accepted, and which rows cross.
#include "lab/compare/threshold.h"
#include "base/error.h"
#include "lab/core/maps.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

std::vector<Row> twoRows() {
  Row bad;
  bad.map = "spot";
  bad.bias = "none";
  bad.scored = 10000;
  bad.acne = 30;
  bad.leak = 10;
  bad.agree = 9960;
  Row good = bad;
  good.bias = "adaptive";
  good.acne = 0;
  good.leak = 0;
  good.agree = 10000;
  return {bad, good};
}

bool crosses(const char* text) {
  return crossed(parseThreshold(text), twoRows()).has_value();
}

TEST(Threshold, ComparesCountsAndShares) {
  EXPECT_TRUE(crosses("acne>29"));
  EXPECT_FALSE(crosses("acne>30"));
  EXPECT_TRUE(crosses("acne>=30"));
  EXPECT_TRUE(crosses("acne>0.29%"));
  EXPECT_FALSE(crosses("acne>0.31%"));
  EXPECT_TRUE(crosses("bias_error>0.003"));
  EXPECT_TRUE(crosses("bias_error > 0.39 %"));
  EXPECT_FALSE(crosses("bias_error>0.41%"));
  EXPECT_FALSE(crosses("edge>0"));
}

TEST(Threshold, MayNameTheRowsItMeans) {
  EXPECT_FALSE(crosses("adaptive:acne>0"));
  EXPECT_TRUE(crosses("none:acne>0"));
  EXPECT_TRUE(crosses("spot/none:leak>0"));
}

CompareOptions compared(const char* maps, const char* biases) {
  CompareOptions options;
  options.maps = parseMaps(maps);
  options.biases = parseBiases(biases);
  return options;
}

std::string complaintOf(const char* text, const CompareOptions& options) {
  try {
    checkMeansARow(parseThreshold(text), options);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Threshold, ThatMeansNoRowIsRefusedWithTheNearestName) {
  const CompareOptions options = compared("spot,vsv", "none,slope,adaptive");
  for (const char* text : {"acne>0", "adaptive:acne>0", "vsv/adaptive:acne>0", "spot/slope:leak>0"})
    EXPECT_EQ(complaintOf(text, options), "") << text;
  EXPECT_NE(complaintOf("adaptiv:acne>0.1%", options).find("bias 'adaptiv' is not compared; did you mean adaptive?"),
            std::string::npos);
  EXPECT_NE(complaintOf("constant:acne>0", options).find("bias 'constant' is not compared"), std::string::npos);
  EXPECT_NE(complaintOf("cube/none:leak>0", options).find("map 'cube' is not compared; choose from spot, vsv"),
            std::string::npos);
  EXPECT_NE(complaintOf("vsv/slope:leak>0", options).find("a vsv map is not compared with bias slope"),
            std::string::npos);
  EXPECT_NE(complaintOf("flip>0.1", options).find("with --filters only"), std::string::npos);
  for (const char* text : {"cube/none:leak>0", "flip>0"}) EXPECT_THROW(crosses(text), UsageError) << text;
}

TEST(Threshold, AcceptsEveryNumberOfARow) {
  std::vector<Row> rows = twoRows();
  rows[0].flip = 0.25;
  rows[0].frameMs = 12.0;
  for (const char* text : {"flip>0.2", "flip>20%", "frame_ms>11", "all_wrong>0.3%", "agree<9961", "agree<99.7%",
                           "wrong>=40", "build_ms<=0"})
    EXPECT_TRUE(crossed(parseThreshold(text), rows)) << text;
  for (const char* text : {"flip>0.3", "frame_ms>12", "all_wrong>0.5%", "wrong>40"})
    EXPECT_FALSE(crossed(parseThreshold(text), rows)) << text;
  EXPECT_THROW(parseThreshold("frame_ms>5%"), UsageError);
  try {
    parseThreshold("all_wrog>1%");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean all_wrong?"), std::string::npos) << error.what();
  }
}

TEST(Threshold, SaysWhichRowCrossed) {
  const std::string line = *crossed(parseThreshold("acne>0.1%"), twoRows());
  EXPECT_NE(line.find("spot none: acne is 0.3%"), std::string::npos) << line;
}

TEST(Threshold, RefusesWhatItDoesNotUnderstand) {
  for (const char* text :
       {"", "acne", "acne>", ">3", "acne>x", "moire>3", "acne>1e999", "acne>3%%", "acne=3", "acne>--3"})
    EXPECT_THROW(parseThreshold(text), UsageError) << text;
}

}  // namespace
}  // namespace gnomon
