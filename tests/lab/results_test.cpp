// results.json: every field is declared, documented, and comes back as it was written.
#include "lab/compare/results.h"
#include "base/error.h"
#include "base/file.h"
#include "lab/compare/compare.h"
#include "lab/core/maps.h"
#include "lab/fog/fog_report.h"
#include "lab/results/json_schema.h"
#include "lab/results/results_file.h"
#include "tests/gpu_fixture.h"
#include "vsv/volume_parameterization.h"

#include "tests/base/places.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

using gpu::TemporaryFolder;
using Json = nlohmann::ordered_json;

// The table of docs/results.md of one struct.
template <Record R>
std::string fieldTable() {
  std::string text = "| field | unit | |\n|---|---|---|\n";
  forEachField<R>([&](const auto& field) {
    if (field.notes.inFile) text += fmt::format("| `{}` | {} | {} |\n", field.name, field.notes.unit, field.notes.says);
  });
  return text + "\n";
}

template <Record... R>
void expectTables(const std::string& docs) {
  (([&] {
     EXPECT_NE(docs.find(fieldTable<R>()), std::string::npos) << "docs/results.md lacks this table:\n\n"
                                                              << fieldTable<R>();
   }()),
   ...);
}

TEST(ResultsDocs, HaveTheTableOfEveryDeclaredField) {
  const std::string docs = readFile(test::inSource("docs/results.md"));
  expectTables<Comparison, ProgramFacts, SceneFacts, CameraFacts, LightFacts, TruthSummary, MapSummary,
               TexelSolidAngles, Row, Walks, WorstPlace, Tuning, CameraTransfer, MapSizeTransfer, Elsewhere,
               CameraError, MapSizeError, EqualError, EqualErrorMethod, SizedError>(docs);
  expectTables<MediaResults, MediumFacts, DensityFacts, ReferenceFacts, FramesFacts, MediaRow, EqualTerms, Factor>(
      docs);
  EXPECT_NE(docs.find(fmt::format("## results.json, schema {}\n", kResultsVersion)), std::string::npos);
}

TEST(ResultsSchema, IsMadeOfTheDeclaredFields) {
  const std::filesystem::path path = test::inSource("docs/results.schema.json");
  if (std::getenv("GNOMON_BLESS") != nullptr) writeTextFile(path, resultsJsonSchema());
  EXPECT_EQ(readFile(path), resultsJsonSchema()) << "tools/bless writes it anew";
}

// `text` in a folder, read and written again.
template <typename Kind>
Kind expectSameWhenRead(const std::string& text) {
  const TemporaryFolder folder;
  writeTextFile(folder.path() / "results.json", text);
  const Kind read = std::get<Kind>(readResults(folder.path()));
  const std::string again = resultsText(read);
  const auto [a, b] = std::ranges::mismatch(again, text);
  EXPECT_TRUE(again == text) << "from here on: " << std::string(a, again.end()).substr(0, 200) << "\n, not "
                             << std::string(b, text.end()).substr(0, 200);
  return read;
}

TEST(ResultsFile, AComparisonComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  const Session session({.validation = true}, {.scene = "atrium", .light = "all", .size = "64"});
  CompareOptions options;
  options.maps = parseMaps("cube,vsv");
  options.biases = parseBiases("constant,adaptive");
  options.filters = parseFilters("none,bilinear");
  options.mapSide = 64;
  options.mapOptions.set(kVolumeSize({.alpha = 64, .theta = 64, .phi = 128}));
  options.tune = true;
  options.repeats = 1;
  options.outDir = folder.path();
  const Comparison written = compare(session, options);
  const Comparison read = expectSameWhenRead<Comparison>(resultsJson(session, written, "gnomon compare atrium"));
  ASSERT_EQ(read.rows.size(), written.rows.size());
  size_t filtered = 0, tuned = 0, placed = 0, sums = 0;
  for (size_t i = 0; i < read.rows.size(); ++i) {
    const Row &a = read.rows[i], &b = written.rows[i];
    EXPECT_EQ(a.params, b.params);
    EXPECT_EQ(a.units, b.units);
    EXPECT_EQ(a.pictures, b.pictures);
    EXPECT_EQ(a.wrong(), b.wrong());
    EXPECT_EQ(a.frameMs, b.frameMs);
    filtered += a.flip.has_value();
    tuned += a.tuning && a.tuning->otherCamera && a.tuning->otherMapSize;
    placed += a.worstAcne || a.worstLeak;
    sums += a.isSum;
  }
  // What is optional was there to be read.
  for (const size_t count : {filtered, tuned, placed, sums}) EXPECT_GT(count, 0u);
  EXPECT_TRUE(read.maps.front().solidAngles);
  EXPECT_FALSE(read.maps.front().filteredTruths.empty());
}

TEST(ResultsFile, AMediumComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  setenv("GNOMON_CACHE_DIR", (folder.path() / "cache").c_str(), 1);
  const Session session({.validation = true}, {.scene = "grate", .size = "48x36"});
  FogOptions options{.integrators = {&findIntegrator("runs"), &findIntegrator("march")},
                     .steps = {8, 32},
                     .marchMap = parseMaps("cube").front(),
                     .mapSide = 64,
                     .truth = true,
                     .cache = false,
                     .reference = {.bound = 0.05},
                     .repeats = 1,
                     .motion = FogMotion{.frames = 2, .offsetW = {0.2f, 0.0f, 0.0f}},
                     .outDir = folder.path() / "out"};
  options.map.set(kVolumeSize({.alpha = 64, .theta = 64, .phi = 128}));
  const FogResult result = runFog(session, options);
  const MediaResults read = expectSameWhenRead<MediaResults>(fogJson(session, options, result, "gnomon fog grate"));
  ASSERT_EQ(read.rows.size(), 3u);
  EXPECT_TRUE(read.reference && read.worst && read.frames && read.rows.front().flicker);
  EXPECT_EQ(read.rows[0].relRmse, result.rows[0].relRmse);
  EXPECT_EQ(read.rows[2].steps, 32);
  EXPECT_FALSE(read.equalTerms.empty());
}

// One struct with each kind of value, so that none is lost by a writer and a reader that agree.
TEST(ResultsFile, HoldsWhatTheStructsHold) {
  Comparison comparison;
  comparison.scene.sceneScale = 0.1f;
  comparison.camera = {.name = "eye", .eye = {0.1f, 2.0f, -3.0f}, .fovDegrees = 36.0f, .width = 8, .height = 4};
  comparison.rows.push_back({.map = "cube",
                             .mapSide = 64,
                             .params = {{"offset", 1.0}, {"cull", "solids"}, {"cascades", int64_t{1}}},
                             .units = {{"offset", "m"}},
                             .scored = 8,
                             .agree = 5,
                             .acne = 2,
                             .leak = 1});
  const Json json = Json::parse(resultsText(comparison));
  EXPECT_EQ(json.at("scene").at("sceneScale"), 0.1);
  EXPECT_EQ(json.at("camera").at("eye").dump(), "[0.1,2.0,-3.0]");
  const Json& row = json.at("rows").at(0);
  EXPECT_EQ(row.at("params").dump(), R"({"offset":1.0,"cull":"solids","cascades":1})");
  EXPECT_EQ(row.at("units").dump(), R"({"offset":"m"})");
  EXPECT_EQ(row.at("bias_error"), 0.375);
  EXPECT_TRUE(row.at("flip").is_null());
  EXPECT_FALSE(row.contains("edge"));  // a metric of --fail-if alone
  const Comparison read = expectSameWhenRead<Comparison>(resultsText(comparison));
  EXPECT_EQ(read.rows.front().params, comparison.rows.front().params);
  EXPECT_EQ(read.camera.eye, comparison.camera.eye);
}

TEST(ResultsFile, NumbersOutOfRangeAreRefusedByName) {
  const TemporaryFolder folder;
  const auto complaint = [&](const char* field, const Json& value) -> std::string {
    MediaResults media;
    media.camera.width = media.camera.height = 1;
    media.rows.push_back({.integrator = "runs", .map = "vsv"});
    Json json = Json::parse(resultsText(media));
    json["media"][0][field] = value;
    writeTextFile(folder.path() / "results.json", json.dump());
    try {
      readResults(folder.path());
    } catch (const WorldError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint("steps", 4), "");
  EXPECT_NE(complaint("map_ms", -1.0).find("media[0].map_ms must not be negative"), std::string::npos);
  EXPECT_NE(complaint("rel_rmse", -0.1).find("media[0].rel_rmse must not be negative"), std::string::npos);
  EXPECT_NE(complaint("steps", 1e10).find("media[0].steps must be a whole number"), std::string::npos);
  EXPECT_NE(complaint("steps", 10000000000).find("media[0].steps must be at most 2147483647"), std::string::npos);
}

}  // namespace
}  // namespace gnomon
