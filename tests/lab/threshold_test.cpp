// --fail-if: what is accepted, and which rows cross.
#include "lab/compare/threshold.h"
#include "base/error.h"

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
  EXPECT_FALSE(crosses("cube/none:leak>0"));
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
