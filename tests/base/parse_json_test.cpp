// JSON is read in a time that grows with its length, and not where it is deep.
#include <nlohmann/json.hpp>

#include "base/parse_json.h"

#include <ctime>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

std::string messageOf(const std::string& text, const JsonLimits& limits) {
  try {
    parseJson<nlohmann::ordered_json>(text, limits);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(ParseJsonTest, DepthAndMembersAreLimited) {
  const auto nested = [](size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_EQ(messageOf(nested(64), {}), "");
  EXPECT_EQ(messageOf(nested(65), {}), "the JSON is nested more than 64 deep");
  EXPECT_EQ(messageOf(std::string(5'000'000, '['), {}), "the JSON is nested more than 64 deep");
  EXPECT_EQ(messageOf(R"({"a": {"b": 1}, "c": {"d": 1, "e": 2}})", {.members = 2}), "");
  EXPECT_EQ(messageOf(R"({"a": {"b": 1}, "c": {"d": 1, "e": 2, "f": 3}})", {.members = 2}),
            "an object has more than 2 members");
  EXPECT_NE(messageOf("{\"a\": ", {}).find("parse error"), std::string::npos);
}

// Of the processor, whatever else runs.
double secondsOf(size_t objects) {
  std::string text = "[";
  for (size_t i = 0; i < objects; ++i) text += (i == 0 ? "" : ",") + std::string(R"({"mesh":0})");
  text += "]";
  const std::clock_t begin = std::clock();
  EXPECT_EQ(parseJson<nlohmann::json>(text, {}).size(), objects);
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Quadratic, sixteen times as many would take 256 times as long.
TEST(ParseJsonTest, SixteenTimesAsManyObjectsTakeAboutSixteenTimesAsLong) {
  EXPECT_LT(secondsOf(320'000), 100.0 * (secondsOf(20'000) + 1e-3));
}

}  // namespace
}  // namespace gnomon
