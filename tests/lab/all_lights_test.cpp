// --light all: each light on its own, and sums that add up.
#include "base/error.h"
#include "base/file.h"
#include "lab/compare/compare.h"
#include "lab/compare/results.h"
#include "lab/core/maps.h"
#include "lab/page/report.h"
#include "scene/generate.h"
#include "tests/base/temporary_folder.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

TEST(AllLights, SumsAddUpAndThePageNamesEachLight) {
  const test::TemporaryFolder folder;
  const SetupOptions setup{.scene = "atrium", .light = "all", .size = "96"};
  const Session session({.validation = true}, setup);
  CompareOptions options;
  options.maps = parseMaps("cube,paraboloid");
  options.biases = parseBiases("none,adaptive");
  options.mapSide = 64;
  options.repeats = 1;
  options.outDir = folder.path();
  const Comparison comparison = compare(session, options);
  // Two point lights (the sun is not for these maps), two maps, two biases; and a sum for each map and bias.
  ASSERT_EQ(comparison.rows.size(), 12u);
  EXPECT_EQ(std::ranges::count_if(comparison.rows, &Row::isSum), 4);
  for (const Row& sum : comparison.rows) {
    if (!sum.isSum) continue;
    size_t scored = 0, acne = 0, agree = 0;
    for (const Row& row : comparison.rows) {
      if (row.isSum || row.map != sum.map || row.bias != sum.bias) continue;
      scored += row.scored;
      acne += row.acne;
      agree += row.agree;
    }
    EXPECT_EQ(sum.scored, scored);
    EXPECT_EQ(sum.acne, acne);
    EXPECT_EQ(sum.agree, agree);
    EXPECT_EQ(sum.scored, sum.agree + sum.acne + sum.leak + sum.edgeShadow + sum.edgeLight + sum.uncovered);
  }
  const std::string json = resultsJson(session, comparison, "gnomon compare atrium --light all --maps cube,paraboloid");
  writeTextFile(folder.path() / "results.json", json);
  EXPECT_EQ(nlohmann::json::parse(json).at("maps").size(), 4u);
  const std::string page = reportHtml(folder.path());
  EXPECT_NE(page.find("cube, lantern"), std::string::npos);
  EXPECT_NE(page.find("paraboloid, brazier"), std::string::npos);
  EXPECT_NE(page.find("--light brazier"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "cube/light1/unfolded.png"));
}

// Of the bias each light has values of its own; the filter's are those of all of them.
TEST(AllLights, ASumOfTunedRowsKeepsTheFiltersParameters) {
  const Session session({.validation = true}, {.scene = "atrium", .light = "all", .size = "48"});
  CompareOptions options;
  options.maps = parseMaps("cube");
  options.biases = parseBiases("constant");
  options.filters = parseFilters("jitter4x4");
  options.mapSide = 32;
  options.repeats = 1;
  options.tune = true;
  options.tuneElsewhere = false;
  const Comparison comparison = compare(session, options);
  size_t tuned = 0;
  for (const Row& sum : comparison.rows) {
    if (!sum.isSum) continue;
    EXPECT_EQ(paramText(sum.params, "filter_width"), "4");
    EXPECT_EQ(sum.unitOf("filter_width"), "texels");
    EXPECT_EQ(paramText(sum.params, "offset").empty(), sum.isTuned());
    tuned += sum.isTuned() ? 1 : 0;
  }
  EXPECT_EQ(tuned, 1u);
}

TEST(AllLights, AMapThatNoLightIsForSaysSo) {
  Scene scene = openScene("lshape");
  std::erase_if(scene.lights, [](const Light& light) { return light.type != LightType::Directional; });
  ASSERT_FALSE(scene.lights.empty());
  const Tracer tracer(scene);
  const SetupOptions all{.light = "all"};
  EXPECT_EQ(chooseLights(all, tracer, *parseMaps("directional").front()).size(), scene.lights.size());
  try {
    chooseLights(all, tracer, *parseMaps("cube").front());
    FAIL();
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("--light all: the scene has no light that a cube map"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace gnomon
