// The shadow volume as one more map of the comparison.
#include "base/file.h"
#include "lab/compare/compare.h"
#include "lab/compare/results.h"
#include "lab/core/maps.h"
#include "tests/gpu_fixture.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

using Json = nlohmann::json;

CompareOptions optionsWith(VolumeSource source, VolumeFit fit) {
  CompareOptions options;
  options.maps = parseMaps("cube,vsv");
  options.biases = parseBiases("none,dual,adaptive");
  options.filters = parseFilters("none");
  options.mapSide = 64;
  options.mapOptions.set(kVolumeSize({.alpha = 128, .theta = 192, .phi = 128}));
  options.mapOptions.set(kVolumeSource(source));
  options.mapOptions.set(kVolumeFit(fit));
  options.repeats = 1;
  return options;
}

// Everything but the times.
std::string runTwiceEqual(const Session& session, const CompareOptions& options) {
  std::string first;
  for (int i = 0; i < 2; ++i) {
    Comparison comparison = compare(session, options);
    comparison.gbufferMs = 0.0;
    for (TruthSummary& truth : comparison.truths) truth.receiversAndTraceMs = truth.fitMs = 0.0;
    for (Row& row : comparison.rows) row.buildMs = row.shadeMs = row.frameMs = 0.0;
    const std::string json = resultsJson(session, comparison, "gnomon compare");
    if (i == 0) first = json;
    EXPECT_EQ(json, first);
  }
  return first;
}

TEST(VolumeCompare, ItsRowsHaveTheBiasesThatMeanSomethingAndAddUp) {
  const gpu::TemporaryFolder folder;
  const SetupOptions setup{.scene = "contact", .size = "96x72"};
  const Session session({.validation = true}, setup);
  for (const auto& [source, fit] :
       {std::pair(VolumeSource::Direct, VolumeFit::Frustum), std::pair(VolumeSource::Resample, VolumeFit::Full)}) {
    CompareOptions options = optionsWith(source, fit);
    options.outDir = folder.path();
    const Json json = Json::parse(runTwiceEqual(session, options));
    std::set<std::string> biases;
    size_t cubeRows = 0;
    for (const Json& row : json.at("rows")) {
      uint64_t sum = 0;
      for (const char* key : {"agree", "acne", "leak", "edge_shadow", "edge_light", "uncovered"})
        sum += row.at(key).get<uint64_t>();
      EXPECT_EQ(sum, row.at("scored").get<uint64_t>());
      EXPECT_EQ(row.at("uncovered"), 0);
      if (row.at("map") == "cube") {
        ++cubeRows;
        EXPECT_FALSE(row.at("params").contains("vsv_size"));
        continue;
      }
      biases.insert(row.at("bias"));
      EXPECT_EQ(row.at("filter"), "none");
      EXPECT_EQ(row.at("map_texels"), 192 * 128);
      EXPECT_EQ(row.at("params").at("vsv_size"), "128x192x128");
      EXPECT_EQ(row.at("params").at("vsv_source"), kVolumeSource.text(source));
      EXPECT_EQ(row.at("params").at("vsv_fit"), kVolumeFit.text(fit));
      EXPECT_EQ(row.at("params").contains("cube_size"), source == VolumeSource::Resample);
      for (const auto& picture : row.at("pictures"))
        EXPECT_TRUE(std::filesystem::exists(folder.path() / picture.get<std::string>()));
    }
    EXPECT_EQ(cubeRows, 3u);
    EXPECT_EQ(biases, (std::set<std::string>{"none", "adaptive"}));
  }
  EXPECT_TRUE(session.device().validationMessages().empty());
}

TEST(VolumeCompare, AdaptiveHasNoAcneOnSlopeAndNoneHasPlenty) {
  const Session session({.validation = true}, {.scene = "tilted-planes", .size = "256"});
  CompareOptions options = optionsWith(VolumeSource::Direct, VolumeFit::Frustum);
  options.maps = parseMaps("vsv");
  const Comparison comparison = compare(session, optionsFor(options, *options.maps.front()));
  std::set<std::string> biases;
  for (const Row& row : comparison.rows) {
    biases.insert(row.bias);
    if (row.bias == "adaptive") {
      EXPECT_EQ(row.acne, 0u);
    } else if (row.bias == "none") {
      EXPECT_GT(row.acne, row.scored / 10);
    }
  }
  EXPECT_EQ(biases, (std::set<std::string>{"none", "adaptive"}));
}

TEST(VolumeCompare, KnobsAreTunedAndJudgedAtHalfTheSize) {
  const Session session({.validation = true}, {.scene = "tilted-planes", .size = "96"});
  CompareOptions options = optionsWith(VolumeSource::Direct, VolumeFit::Frustum);
  options.maps = parseMaps("vsv");
  options.biases = parseBiases("constant");
  options.tune = true;
  const Comparison comparison = compare(session, options);
  ASSERT_EQ(comparison.rows.size(), 2u);
  const Row& tuned = comparison.rows[1];
  ASSERT_TRUE(tuned.tuning && tuned.tuning->otherMapSize);
  EXPECT_EQ(tuned.tuning->otherMapSize->mapSize, 96);  // columns along theta: half of 192
  EXPECT_LE(tuned.biasError(), comparison.rows[0].biasError());
  EXPECT_LT(tuned.biasError(), 0.05);
}

}  // namespace
}  // namespace gnomon
