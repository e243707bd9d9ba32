// Both papers end to end, small: every figure, table and verdict is there, in the results and on the page.
#include "lab/paper/reproduce.h"
#include "base/error.h"
#include "base/file.h"
#include "tests/base/temporary_folder.h"

#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

constexpr double kScale = 0.06;  // pictures of 31 to 66 pixels

class ReproduceTest : public ::testing::Test {
 protected:
  Reproduction run(const std::string& paper, const std::string& scene = "") {
    options_ = {.paper = paper, .scene = scene, .outDir = folder_.path(), .scale = kScale, .repeats = 1};
    return reproduce({.validation = true}, options_);
  }

  void expectAllOnThePage(const Reproduction& result) {
    const std::string page = reproductionHtml(result, options_, "gnomon reproduce");
    EXPECT_TRUE(page.starts_with("<!doctype html>"));
    EXPECT_TRUE(page.ends_with("</html>\n"));
    size_t pictures = 0;
    for (const Figure& figure : result.figures) {
      EXPECT_NE(page.find("id=\"figure-" + figure.id + "-title\""), std::string::npos) << figure.id;
      for (size_t i = 0; i < figure.panels.size(); ++i) {
        EXPECT_NE(page.find("id=\"panel-" + figure.id + "-" + std::to_string(i + 1) + "\""), std::string::npos);
        pictures += figure.panels[i].picture.empty() ? 0 : 1;
      }
      EXPECT_TRUE(!figure.panels.empty() || !figure.svg.empty()) << figure.id;
    }
    EXPECT_GE(occurrences(page, "src=\"data:image/"), pictures);
    EXPECT_EQ(occurrences(page, "<li id=\"claim-"), result.claims.size());
    EXPECT_EQ(occurrences(page, "<tbody>"), result.tables.size());
    // Nothing is asked of a network or of another file.
    EXPECT_EQ(occurrences(page, "src=\""), occurrences(page, "src=\"data:"));
    EXPECT_EQ(page.find("<link rel=\"stylesheet"), std::string::npos);
    EXPECT_EQ(page.find("cannot be read"), std::string::npos);
    EXPECT_EQ(page.find("{{"), std::string::npos);
    EXPECT_NE(page.find("the verdicts are meant for scale 1"), std::string::npos);
    EXPECT_TRUE(reproductionText(result).starts_with("at scale 0.06: the verdicts are meant for scale 1"));
  }

  static size_t occurrences(const std::string& text, const std::string& what) {
    size_t count = 0;
    for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
    return count;
  }

  static std::set<std::string> figuresOf(const Reproduction& result) {
    std::set<std::string> ids;
    for (const Figure& figure : result.figures) ids.insert(figure.id);
    return ids;
  }

  test::TemporaryFolder folder_;
  ReproduceOptions options_;
};

TEST_F(ReproduceTest, WeiskopfAndErtl) {
  const Reproduction result = run("weiskopf2003");
  EXPECT_EQ(figuresOf(result), (std::set<std::string>{"5", "6", "7"}));
  EXPECT_EQ(result.figures[0].panels.size(), 6u);
  EXPECT_EQ(result.figures[1].panels.size(), 6u);
  EXPECT_EQ(result.figures[2].panels.size(), 4u);
  EXPECT_EQ(result.tables.front().rows.size(), 6u);
  EXPECT_TRUE(result.leftOut.empty());
  for (const JudgedClaim& judged : result.claims) EXPECT_NE(judged.verdict, ClaimVerdict::NotRun) << judged.claim.says;
  // What no scale changes: an endless offset is no offset.
  EXPECT_EQ(result.numbers.at("error(dual, endless offset)"), result.numbers.at("error(midpoint)"));
  EXPECT_GT(result.numbers.at("leak(5d)"), 10 * result.numbers.at("leak(5f)"));
  expectAllOnThePage(result);
  const auto json = nlohmann::json::parse(reproductionJson(result, options_, "gnomon reproduce"));
  EXPECT_EQ(json.at("claims").size(), result.claims.size());
  EXPECT_EQ(json.at("comparisons").size(), 4u);
  EXPECT_EQ(json.at("comparisons")[0].at("results").at("rows").size(), 2u);
  EXPECT_EQ(json.at("claims")[0].at("numbers").at("leak(5b)"), result.numbers.at("leak(5b)"));
}

TEST_F(ReproduceTest, DouAndOthers) {
  const Reproduction result = run("dou2014");
  EXPECT_EQ(figuresOf(result), (std::set<std::string>{"1", "6", "7", "8", "9", "10", "12", "13"}));
  EXPECT_TRUE(result.leftOut.empty());
  for (const JudgedClaim& judged : result.claims) EXPECT_NE(judged.verdict, ClaimVerdict::NotRun) << judged.claim.says;
  // The printed equation 6 puts every depth behind the far end: whatever is lit turns dark.
  EXPECT_GT(result.numbers.at("depth(equation 6, near)"), 1.0);
  EXPECT_GT(result.numbers.at("depth(equation 6, far)"), 1.0);
  EXPECT_GT(result.numbers.at("wrong(equation 6, as printed)"),
            5 * result.numbers.at("wrong(equation 6, b with the other sign)"));
  EXPECT_EQ(result.numbers.at("leak(equation 6, as printed)"), 0.0);
  for (const char* reading : {"the ray as printed", "the normal as printed", "the ray not normalized"})
    EXPECT_GT(result.numbers.at(std::string("wrong(section 3.2, ") + reading + ")"),
              2 * result.numbers.at("wrong(section 3.2, the unit normal)"))
        << reading;
  EXPECT_NEAR(result.numbers.at("published(dual)"), 1.563, 0.001);
  expectAllOnThePage(result);
}

TEST_F(ReproduceTest, OnAUsersSceneWhatItLacksIsLeftOutAndSaid) {
  // One camera, which does not turn its back on the lamp.
  const Reproduction result = run("dou2014", "tilted-planes");
  for (const char* what : {"figure 6", "figure 7", "figure 13"})
    EXPECT_NE(reproductionText(result).find(std::string("left out            ") + what + ": "), std::string::npos)
        << reproductionText(result);
  EXPECT_EQ(figuresOf(result), (std::set<std::string>{"1", "8", "9", "10", "12"}));
  for (const JudgedClaim& judged : result.claims)
    EXPECT_EQ(judged.verdict == ClaimVerdict::NotRun, !judged.missing.empty());
  expectAllOnThePage(result);
}

TEST_F(ReproduceTest, WhatIsNotThereIsRefused) {
  EXPECT_THROW(run("williams1978"), UsageError);
  EXPECT_THROW(run("dou2014", (folder_.path() / "nowhere.glb").string()), WorldError);
  options_ = {.paper = "dou2014", .scale = 1.5};
  EXPECT_THROW(reproduce({}, options_), UsageError);
}

}  // namespace
}  // namespace gnomon
