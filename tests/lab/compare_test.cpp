// The main job end to end: rows that add up, results.json as docs/results.md has it, and the same bytes twice.
#include "lab/compare/compare.h"
#include "base/file.h"
#include "lab/compare/results.h"
#include "lab/compare/table.h"
#include "lab/core/maps.h"
#include "lab/picture/pictures.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "scene/generate.h"
#include "scene/gltf.h"
#include "tests/gpu_fixture.h"
#include "vsv/volume_parameterization.h"

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

using gpu::TemporaryFolder;
using Json = nlohmann::json;
namespace fs = std::filesystem;

struct Outcome {
  Json json;
  std::map<std::string, std::string> files;  // name below the folder -> bytes
  Comparison comparison;
  std::string table;
};

// `withFiles`: writes its pictures, which takes longer than all the rest.
Outcome run(const std::string& scene, const std::string& maps, bool withFiles = true) {
  const TemporaryFolder folder;
  const SetupOptions setup{.scene = scene, .size = "160x120"};
  const Session session({.validation = true}, setup);
  CompareOptions options;
  options.maps = parseMaps(maps);
  options.biases = parseBiases("all");
  options.mapSide = 128;
  options.repeats = 1;
  if (withFiles) options.outDir = folder.path();
  Outcome outcome;
  outcome.comparison = compare(session, options);
  outcome.json = Json::parse(resultsJson(session, outcome.comparison, "gnomon compare"));
  outcome.table = comparisonTable(outcome.comparison);
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    if (entry.is_regular_file())
      outcome.files[fs::relative(entry.path(), folder.path()).string()] = readFile(entry.path());
  EXPECT_TRUE(session.device().validationMessages().empty());
  return outcome;
}

// Removes what is allowed to differ between two runs.
void dropTimes(Json& json) {
  if (json.is_object()) {
    for (auto it = json.begin(); it != json.end();) it = it.key().ends_with("_ms") ? json.erase(it) : std::next(it);
  }
  if (json.is_structured())
    for (Json& child : json) dropTimes(child);
}

TEST(Compare, TheSameCommandGivesTheSameBytes) {
  Outcome a = run("contact", "spot,directional");
  Outcome b = run("contact", "spot,directional");
  dropTimes(a.json);
  dropTimes(b.json);
  EXPECT_EQ(a.json.dump(), b.json.dump());
  // A map: depth, second depth and gap as PNG and EXR, the truth twice. A row: four PNGs and the data.
  EXPECT_EQ(a.files.size(), 2u * (8 + 5 * biasMethods().size()));
  EXPECT_EQ(a.files, b.files);
}

// Two lights, three maps that take a point light as it is: a ground truth a light, not a map.
TEST(Compare, TracesEachLightOnce) {
  Scene scene = openScene(std::string("contact"));
  scene.lights.resize(1);
  scene.lights.front().type = LightType::Point;
  scene.lights.push_back(scene.lights.front());
  scene.lights.back().name = "second";
  scene.lights.back().positionW += glm::vec3(0.3f, 0.1f, 0.2f);
  const TemporaryFolder folder;
  const std::string file = folder.path() / "two.glb";
  saveGlb(scene, file);
  const Session session({.validation = true}, {.scene = file, .light = "all", .size = "64"});
  CompareOptions options;
  options.maps = parseMaps("cube,paraboloid,vsv");
  options.biases = parseBiases("constant,adaptive");
  options.mapOptions.set(kVolumeSize({.alpha = 64, .theta = 64, .phi = 128}));
  options.mapSide = 64;
  options.repeats = 1;
  const Comparison comparison = compare(session, options);
  EXPECT_EQ(comparison.truths.size(), 6u);
  EXPECT_EQ(session.groundTruths().tracedCount(), 2u);
}

TEST(Compare, ResultsFollowTheSchema) {
  const Outcome outcome = run("lshape", "spot,directional");
  const Json& json = outcome.json;
  EXPECT_EQ(json.at("schema"), kResultsVersion);
  for (const char* key : {"version", "device", "driver", "command"}) EXPECT_TRUE(json.at("gnomon").at(key).is_string());
  EXPECT_GT(json.at("scene").at("triangles"), 0);
  EXPECT_GT(json.at("scene").at("sceneScale"), 0.0);
  EXPECT_EQ(json.at("camera").at("width"), 160);
  EXPECT_EQ(json.at("truths").size(), 2u);
  EXPECT_EQ(json.at("truth"), json.at("truths")[0]);
  for (const Json& truth : json.at("truths")) {
    for (const char* key : {"scored", "lit", "facing_away", "outside_cone", "margin_flips_half", "margin_flips_double"})
      EXPECT_TRUE(truth.at(key).is_number_unsigned()) << key;
    EXPECT_TRUE(truth.at("light").at("type").is_string());
  }
  ASSERT_EQ(json.at("rows").size(), 2u * biasMethods().size());
  for (const Json& row : json.at("rows")) {
    uint64_t sum = 0;
    for (const char* key : {"agree", "acne", "leak", "edge_shadow", "edge_light", "uncovered"})
      sum += row.at(key).get<uint64_t>();
    EXPECT_EQ(sum, row.at("scored").get<uint64_t>());
    const double error = (row.at("acne").get<double>() + row.at("leak").get<double>()) / row.at("scored").get<double>();
    EXPECT_DOUBLE_EQ(row.at("bias_error").get<double>(), error);
    EXPECT_EQ(row.at("map_texels"), 128 * 128);
    EXPECT_EQ(row.at("filter"), "none");
    EXPECT_TRUE(row.at("params").is_object());
    EXPECT_GE(row.at("build_ms"), 0.0);
    EXPECT_GE(row.at("shade_ms"), 0.0);
    EXPECT_DOUBLE_EQ(
        row.at("frame_ms").get<double>(),
        json.at("gbuffer_ms").get<double>() + row.at("build_ms").get<double>() + row.at("shade_ms").get<double>());
    EXPECT_EQ(row.at("tuned"), false);
    EXPECT_TRUE(row.at("tuning").is_null());
    EXPECT_EQ(row.at("worst_acne").is_null(), row.at("acne") == 0);
    EXPECT_EQ(row.at("worst_leak").is_null(), row.at("leak") == 0);
    for (const char* key : {"labels", "visibility", "beauty", "difference", "data"})
      EXPECT_TRUE(outcome.files.contains(row.at("pictures").at(key).get<std::string>())) << key;
  }
}

// The cells of one column of a table, by the place of its name in the first line: from there to the next name where
// cells stand at the left, and from the name before to there where they stand at the right.
enum class Stands { Left, Right };
std::vector<std::string> cellsOf(const std::string& table, const std::string& name, Stands stands) {
  std::istringstream lines(table);
  std::string head;
  std::getline(lines, head);
  const size_t at = head.find(name);
  EXPECT_NE(at, std::string::npos) << name;
  size_t begin = at, end = at + name.size();
  if (stands == Stands::Left)
    end = std::min(head.find_first_not_of(' ', end), head.size());
  else
    begin = head.find_last_not_of(' ', at - 1) + 1;
  std::vector<std::string> cells;
  for (std::string line; std::getline(lines, line);) {
    std::string cell = line.substr(begin, end - begin);
    cell.erase(0, cell.find_first_not_of(' '));
    cell.erase(cell.find_last_not_of(' ') + 1);
    cells.push_back(cell);
  }
  return cells;
}

TEST(Compare, TheTableHasTheBestFirst) {
  const Outcome outcome = run("tilted-planes", "spot", false);
  const std::vector<Row> rows = ranked(outcome.comparison.rows);
  ASSERT_EQ(rows.size(), biasMethods().size());
  std::vector<std::string> biases, errors;
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_LE(rows[std::max(i, size_t{1}) - 1].biasError(), rows[i].biasError());
    biases.push_back(rows[i].bias);
    errors.push_back(fmt::format("{:.4f}%", 100.0 * rows[i].biasError()));
  }
  EXPECT_EQ(cellsOf(outcome.table, "bias", Stands::Left), biases);
  EXPECT_EQ(cellsOf(outcome.table, "bias error", Stands::Right), errors);
  EXPECT_EQ(biases.back(), "none");
}

TEST(Compare, ThroughFiltersWitnessHasTheLeastErrorInNumbersAndForTheEye) {
  const Session session({.validation = true}, {.scene = "atrium", .size = "160"});
  CompareOptions options;
  options.maps = parseMaps("cube");
  options.biases = parseBiases("slope,adaptive,two-plane,witness");
  options.filters = parseFilters("bilinear,jitter4x4");
  options.mapSide = 256;
  options.repeats = 1;
  const Comparison comparison = compare(session, options);
  ASSERT_EQ(comparison.rows.size(), 8u);
  for (const Row& witness : comparison.rows) {
    ASSERT_TRUE(witness.flip) << witness.bias << ", " << witness.filter;
    if (witness.bias != "witness") continue;
    for (const Row& other : comparison.rows) {
      if (other.filter != witness.filter || other.bias == witness.bias) continue;
      EXPECT_LT(witness.rmse, other.rmse) << other.bias << ", " << other.filter;
      EXPECT_LT(*witness.flip, *other.flip) << other.bias << ", " << other.filter;
    }
  }
}

TEST(Compare, NoPictureHasANanOrAnInfinity) {
  for (const char* scene : {"sheets", "crowd:20000", "factory"}) {
    const Session session({.validation = true}, {.scene = scene, .size = "96"});
    ShadowPasses passes(session);
    for (const Parameterization* map : parameterizations()) {
      LightOnMap lit = openLight(session, passes, *map,
                                 {.side = 64, .options = {kVolumeSize({.alpha = 64, .theta = 64, .phi = 128})}});
      // Those that divide, move the receiver, or read more than one depth.
      for (const char* name : {"constant", "normal-offset", "receiver-plane", "dual", "adaptive-ehm"}) {
        const BiasMethod& bias = findBias(name);
        if (!map->supportsBias(bias)) continue;
        const LabelledResult judged = lit.judge(atDefaults(bias, session));
        for (const float v : judged.visibility) ASSERT_TRUE(v == 0.0f || v == 1.0f) << scene << " " << bias.name;
        for (const float v : lit.radiance(judged.visibility).values)
          ASSERT_TRUE(std::isfinite(v) && v >= 0.0f) << scene << " " << bias.name;
      }
    }
    EXPECT_TRUE(session.device().validationMessages().empty());
  }
}

TEST(LabelPicture, PaintsEachLabelInItsOwnColor) {
  Receivers receivers;
  receivers.width = 8;
  receivers.height = 1;
  receivers.states.assign(8, PixelState::Scored);
  receivers.samples = SurfaceSamples(PerPixel<SurfaceSample>(8));
  Truth truth;
  truth.lit.assign(8, 1);
  truth.lit[7] = 0;
  LabelImage labels;
  labels.labels = {Label::NotScored,  Label::Agree,     Label::Acne,      Label::Leak,
                   Label::EdgeShadow, Label::EdgeLight, Label::Uncovered, Label::Agree};
  const Image8 picture = labelPicture(receivers, truth, labels, "title");
  std::set<std::vector<uint8_t>> colors;
  for (int x = 0; x < 8; ++x) colors.insert({picture.at(x, 0)[0], picture.at(x, 0)[1], picture.at(x, 0)[2]});
  EXPECT_EQ(colors.size(), 8u);
}

TEST(ResultsJson, SaysOfAPointLightsMapWhatIsNotDefault) {
  const SetupOptions setup{.scene = "contact", .size = "64"};
  const Session session({.validation = true}, setup);
  CompareOptions options;
  options.maps = parseMaps("cube,paraboloid");
  options.biases = parseBiases("adaptive");
  options.mapSide = 64;
  options.repeats = 1;
  const auto paramsOf = [&](const MapOptions& mapOptions) {
    options.mapOptions = mapOptions;
    const Json rows = Json::parse(resultsJson(session, compare(session, options), "gnomon compare")).at("rows");
    return std::pair(rows[0].at("params"), rows[1].at("params"));
  };
  const auto [cube, paraboloid] =
      paramsOf({kCubeDepth(CubeDepth::Radial), kCubePasses(SlicePasses::Each),
                kParaboloidRaster(ParaboloidRaster::Vertex), kParaboloidAxisW(glm::dvec3(0.0, 0.6, 0.8))});
  EXPECT_EQ(cube.at("cube_depth"), "radial");
  EXPECT_EQ(cube.at("cube_passes"), "six");
  EXPECT_FALSE(cube.contains("paraboloid_raster"));
  EXPECT_EQ(paraboloid.at("paraboloid_raster"), "vertex");
  EXPECT_EQ(paraboloid.at("paraboloid_axis"), "0,0.6,0.8");
  EXPECT_FALSE(paraboloid.contains("cube_depth"));
  const auto [plainCube, plainParaboloid] = paramsOf({});
  for (const char* name : {"cube_depth", "cube_passes", "paraboloid_raster", "paraboloid_axis"})
    EXPECT_FALSE(plainCube.contains(name) || plainParaboloid.contains(name)) << name;
}

TEST(DrawText, MarksPixelsWithinItsLine) {
  Image8 image(200, 20, 3);
  drawText(image, 2, 3, 1, "acne 12", {255, 255, 255});
  size_t marked = 0;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (image.at(x, y)[0] == 0) continue;
      ++marked;
      EXPECT_LT(y, 15);
      EXPECT_LT(x, 60);
    }
  }
  EXPECT_GT(marked, 40u);
}

TEST(Median, OfOddAndEvenCounts) {
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(median({}), 0.0);
}

}  // namespace
}  // namespace gnomon
