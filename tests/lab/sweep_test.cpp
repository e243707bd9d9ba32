// A sweep measures what compare measures, once, and only what is missing.
#include "lab/sweep/sweep.h"

#include "base/error.h"
#include "base/file.h"
#include "lab/compare/compare.h"
#include "lab/core/maps.h"
#include "lab/statistics/answers_text.h"
#include "lab/statistics/sweep_page.h"
#include "lab/sweep/measure.h"
#include "lab/sweep/random_places.h"
#include "lab/sweep/results_version.h"
#include "lab/sweep/scene_survey.h"
#include "lab/sweep/slurm.h"
#include "scene/generate.h"
#include "scene/gltf.h"
#include "tests/base/places.h"
#include "tests/gpu_fixture.h"

#include <cstdlib>

#include <fmt/format.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using gpu::TemporaryFolder;

SweepOutcome sweep(const fs::path& db, const std::string& text, int shard = 0, int shards = 1,
                   const fs::path& planPath = "p.json") {
  std::vector<std::string> messages;
  const Plan plan = parsePlan(planPath, text);
  const Axes axes = axesOf(plan);
  SweepOutcome outcome;
  {
    Store store(db, sql::Open::Create);
    outcome = runSweep(plan, axes, store,
                       {.device = {.validation = true, .messageSink = &messages},
                        .program = "test",
                        .planHash = "p",
                        .shard = shard,
                        .shards = shards});
  }
  EXPECT_TRUE(messages.empty()) << messages.front();
  return outcome;
}

// All that must not depend on when, where and in what order it was measured.
std::vector<std::string> contents(const fs::path& db) {
  const Store store(db, sql::Open::Existing);
  std::vector<std::string> lines;
  sql::Statement rows = store.database().prepare(
      "SELECT scene, light, camera, map, map_size, method, filter, scored, agree, acne, leak, edge_shadow, edge_light, "
      "uncovered, unseen_occluder, rmse, parameters, worst_acne, worst_leak, command, key FROM results ORDER BY key");
  while (rows.step()) {
    std::string line;
    for (int i = 0; i < rows.columnCount(); ++i) line += rows.text(i) + "|";
    lines.push_back(line);
  }
  return lines;
}

constexpr const char* kPlan = R"({
  "scenes": ["contact", "corner"], "size": "64", "repeats": 0,
  "cameras": ["default", {"random": 1}],
  "maps": ["cube", "directional"], "map_sizes": [48, 64],
  "biases": ["none", "slope", "witness", {"bias": "constant", "parameters": {"offset": [0.01, 0.1]}}],
  "filters": ["none", "bilinear"], "worst_pictures": 2})";

TEST(Sweep, CountsAreThoseOfCompare) {
  const TemporaryFolder folder;
  const fs::path db = folder.path() / "s.db";
  const SweepOutcome outcome = sweep(db, kPlan);
  EXPECT_EQ(outcome.failed, 0u) << outcome.firstFailure;
  EXPECT_EQ(outcome.measured, outcome.rows);
  EXPECT_EQ(contents(db).size(), outcome.rows);

  const Session session({.validation = true}, {.scene = "contact", .size = "64"});
  CompareOptions options;
  options.maps = parseMaps("cube,directional");
  options.mapSide = 64;
  options.biases = parseBiases("none,slope,witness");
  options.filters = parseFilters("none,bilinear");
  options.repeats = 1;
  const Comparison comparison = compare(session, options);
  const Store store(db, sql::Open::Existing);
  sql::Statement find = store.database().prepare(
      "SELECT scored, agree, acne, leak, edge_shadow, edge_light, uncovered, rmse FROM results WHERE scene = 'contact' "
      "AND camera = ? AND light = ? AND map = ? AND map_size = 64 AND method = ? AND filter = ?");
  for (const Row& row : comparison.rows) {
    ASSERT_TRUE(find.with(session.camera().name, row.light, row.map, row.bias, row.filter).step())
        << row.map << " " << row.light << " " << row.bias;
    int at = 0;
    for (const size_t count : {row.scored, row.agree, row.acne, row.leak, row.edgeShadow, row.edgeLight, row.uncovered})
      EXPECT_EQ(static_cast<size_t>(find.integer(at++)), count) << row.map << " " << row.bias;
    EXPECT_DOUBLE_EQ(find.number(at), row.rmse) << row.map << " " << row.bias;
    find.reset();
  }
}

TEST(Sweep, ASecondRunDoesOnlyWhatIsMissing) {
  const TemporaryFolder folder;
  const fs::path db = folder.path() / "s.db", whole = folder.path() / "whole.db";
  std::string smaller = kPlan;
  smaller.replace(smaller.find("\"slope\", "), 9, "");
  const SweepOutcome first = sweep(db, smaller), second = sweep(db, kPlan), third = sweep(db, kPlan);
  EXPECT_EQ(second.before, first.rows);
  EXPECT_EQ(second.measured, second.rows - first.rows);
  EXPECT_EQ(third.measured, 0u);
  sweep(whole, kPlan);
  EXPECT_EQ(contents(db), contents(whole));
}

TEST(Sweep, AChangedSceneIsMeasuredAgainAndNoOther) {
  const TemporaryFolder folder;
  Scene scene = openScene("corner");
  saveGlb(scene, folder.path() / "mine.glb");
  const std::string plan = R"({"scenes": ["mine.glb", "contact"], "size": "64", "repeats": 0, "maps": ["cube"],
    "map_sizes": [48], "biases": ["none", "slope"]})";
  const fs::path db = folder.path() / "s.db", path = folder.path() / "p.json";
  EXPECT_EQ(sweep(db, plan, 0, 1, path).measured, 4u);
  // A vertex of the floor, then a light.
  scene.meshes.front().positions.front() *= 1.25f;
  saveGlb(scene, folder.path() / "mine.glb");
  EXPECT_EQ(sweep(db, plan, 0, 1, path).measured, 2u);
  EXPECT_EQ(contents(db).size(), 4u);  // what is superseded does not count
  scene.lights.front().positionW.x += 0.125f;
  saveGlb(scene, folder.path() / "mine.glb");
  EXPECT_EQ(sweep(db, plan, 0, 1, path).measured, 2u);
  EXPECT_EQ(contents(db).size(), 4u);
  // A name alone changes nothing.
  scene.meshes.front().name = "another name";
  saveGlb(scene, folder.path() / "mine.glb");
  EXPECT_EQ(sweep(db, plan, 0, 1, path).measured, 0u);
}

TEST(Sweep, ASurveyIsKeptUntilAFileOrTheProgramChanges) {
  const TemporaryFolder folder;
  saveGlb(openScene("corner"), folder.path() / "mine.glb");
  const Plan plan = parsePlan(folder.path() / "p.json", R"({"scenes": ["mine.glb"], "cameras": [{"random": 1}],
    "lights": [{"random": 2}], "maps": ["cube"], "biases": ["none"]})");
  const Axes axes = axesOf(plan);
  Store store(folder.path() / "s.db", sql::Open::Create);
  const Survey first = surveyScenes(plan, axes, &store, "program"),
               second = surveyScenes(plan, axes, &store, "program");
  ASSERT_EQ(second.scenes.size(), 1u);
  const SurveyedScene &a = first.scenes[0], &b = second.scenes[0];
  EXPECT_TRUE(a.traced);
  EXPECT_FALSE(b.traced);  // was not opened
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.diagonal, b.diagonal);
  ASSERT_EQ(b.lights.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.lights[i].name, b.lights[i].name);
    EXPECT_EQ(a.lights[i].text, b.lights[i].text);
    EXPECT_EQ(a.lights[i].thing.positionW, b.lights[i].thing.positionW);
    EXPECT_EQ(a.lights[i].thing.intensity, b.lights[i].thing.intensity);
  }
  ASSERT_EQ(b.cameras.size(), 1u);
  EXPECT_EQ(a.cameras[0].text, b.cameras[0].text);
  EXPECT_EQ(a.cameras[0].thing.worldFromEye, b.cameras[0].thing.worldFromEye);
  EXPECT_EQ(a.cameras[0].thing.yFovRad, b.cameras[0].thing.yFovRad);
  EXPECT_EQ(second.views.size(), 2u);
  EXPECT_TRUE(surveyScenes(plan, axes, &store, "another").scenes[0].traced);
  EXPECT_FALSE(surveyScenes(plan, axes, &store, "another").scenes[0].traced);
  saveGlb(openScene("contact"), folder.path() / "mine.glb");
  const Survey changed = surveyScenes(plan, axes, &store, "another");
  EXPECT_NE(changed.scenes[0].hash, a.hash);
}

TEST(Sweep, ASceneIsAllOfItsFiles) {
  const TemporaryFolder folder;
  const fs::path gltf = folder.path() / "a.gltf", glb = folder.path() / "b.glb";
  writeTextFile(gltf, R"({"buffers": [{"uri": "a%20b.bin"}], "images": [{"uri": "data:image/png;base64,AA=="}, {"uri":
    "t/c.png"}]})");
  EXPECT_EQ(filesOfScene(gltf.string()),
            (std::vector<fs::path>{gltf, folder.path() / "a b.bin", folder.path() / "t/c.png"}));
  saveGlb(openScene("corner"), glb);
  EXPECT_EQ(filesOfScene(glb.string()), std::vector<fs::path>{glb});
  EXPECT_TRUE(filesOfScene("corner").empty());
  writeTextFile(gltf, "no JSON");
  EXPECT_EQ(filesOfScene(gltf.string()), std::vector<fs::path>{gltf});
}

TEST(Sweep, AnotherVersionOfTheResultsIsMeasuredAnewAndAnotherProgramIsNot) {
  const TemporaryFolder folder;
  const fs::path db = folder.path() / "s.db";
  const Plan plan = parsePlan("p.json", R"({"scenes": ["corner"], "maps": ["cube"], "biases": ["none"]})");
  const Axes axes = axesOf(plan);
  const Survey survey = surveyScenes(plan, axes, nullptr, "");
  const Machine machine{.program = "a", .results = "1", .device = "d", .driver = "e", .host = "h"};
  const auto keyWith = [&](auto member, const char* value) {
    Machine other = machine;
    other.*member = value;
    return wantedOf(plan, axes, survey, survey.views.at(0), other).cases.at(0).rows.at(0).key;
  };
  const std::string key = keyWith(&Machine::program, "a");
  EXPECT_EQ(keyWith(&Machine::program, "b"), key);
  EXPECT_EQ(keyWith(&Machine::host, "i"), key);
  EXPECT_NE(keyWith(&Machine::results, "2"), key);
  EXPECT_NE(keyWith(&Machine::device, "f"), key);
  EXPECT_NE(keyWith(&Machine::driver, "f"), key);
}

// Views of one map are every second or third one where a scene has a light for each map.
TEST(Sweep, AShardHasItsShareOfEveryNthView) {
  for (const int shards : {1, 2, 3, 4, 6}) {
    for (const size_t step : {1, 2, 3}) {
      std::vector<int> counts(static_cast<size_t>(shards));
      for (size_t view = 0; view < 144; view += step)
        for (int shard = 0; shard < shards; ++shard)
          counts[static_cast<size_t>(shard)] += SweepOptions{.shard = shard, .shards = shards}.isInShard(view) ? 1 : 0;
      for (const int count : counts) EXPECT_EQ(count, 144 / static_cast<int>(step) / shards) << shards << " " << step;
    }
  }
}

TEST(Sweep, AShardThatIsDoneIsDoneInItsDivisionOnly) {
  const TemporaryFolder folder;
  const SlurmRun run{.store = folder.path() / "all.db", .planHash = "0123", .shards = 2};
  fs::create_directory(run.folder());
  Store part(run.part(1), sql::Open::Create);
  part.setNote("shard 1/2 of 0123", "done");  // as it was written before it had a word for the division
  EXPECT_EQ(missingShards(run), (std::vector<int>{1, 2}));
  part.setNote(shardNote("0123", 1, 2), "done");
  EXPECT_EQ(missingShards(run), std::vector<int>{2});
  EXPECT_NE(shardNote("0123", 1, 2).find(kShardDivision), std::string::npos);
}

TEST(Sweep, ShardsAndAMergeAreTheWhole) {
  const TemporaryFolder folder;
  std::vector<fs::path> parts;
  size_t rows = 0;
  for (int shard = 0; shard < 3; ++shard) {
    parts.push_back(folder.path() / fmt::format("part{}.db", shard));
    rows += sweep(parts.back(), kPlan, shard, 3).measured;
  }
  const fs::path all = folder.path() / "all.db", whole = folder.path() / "whole.db";
  EXPECT_TRUE(mergeStores(parts, all).conflicts.empty());
  EXPECT_EQ(sweep(whole, kPlan).measured, rows);
  EXPECT_EQ(contents(all), contents(whole));
}

TEST(Sweep, TunedMethodsAndMediaAreMeasured) {
  const TemporaryFolder folder;
  const fs::path db = folder.path() / "s.db";
  const SweepOutcome outcome =
      sweep(db, R"({"scenes": ["grate"], "size": "32", "repeats": 1, "maps": ["cube"], "map_sizes": [48],
    "biases": ["constant", {"bias": "constant", "tune": true}],
    "media": [{"integrators": ["runs", "march"], "steps": [8], "bound": 0.05, "map_size": 48}]})");
  EXPECT_EQ(outcome.failed, 0u) << outcome.firstFailure;
  const Store store(db, sql::Open::Existing);
  EXPECT_EQ(store.database().integerOf("SELECT count(*) FROM media_results WHERE rel_rmse > 0 AND integrate_ms > 0"),
            2);
  EXPECT_EQ(store.database().integerOf("SELECT (SELECT bias_error FROM results WHERE tuned) <= (SELECT bias_error FROM "
                                       "results WHERE NOT tuned)"),
            1);
  EXPECT_EQ(sweep(db, R"({"scenes": ["grate"], "size": "32", "repeats": 1,
    "media": [{"integrators": ["march"], "steps": [8], "bound": 0.05, "map_size": 48}]})")
                .measured,
            0u);
}

TEST(Sweep, AnswersRankAndPairAndShow) {
  const TemporaryFolder folder;
  const fs::path db = folder.path() / "s.db";
  sweep(db, R"({"scenes": ["contact", "corner"], "size": "64", "repeats": 1, "maps": ["cube", "directional"],
    "map_sizes": [48], "biases": ["none", "slope", "witness"], "worst_pictures": 3})");
  const Store store(db, sql::Open::Existing);
  const Answers answers = answersOf(store, {});
  ASSERT_EQ(answers.whole().methods.size(), 3u);
  EXPECT_EQ(answers.table.methods[answers.whole().methods.front().method], "witness");
  EXPECT_EQ(answers.table.methods[answers.whole().methods.back().method], "none");
  // The mean of a subset's parts is the whole's.
  double sum = 0.0;
  size_t cases = 0;
  for (size_t scene = 0; scene < answers.table.scenes.size(); ++scene)
    for (const MethodAnswer& answer : answers.find(static_cast<int>(scene), -1, -1)->methods)
      if (answers.table.methods[answer.method] == "none") {
        sum += answer.error.mean.value * static_cast<double>(answer.error.count);
        cases += answer.error.count;
      }
  EXPECT_NEAR(sum / static_cast<double>(cases), answers.whole().methods.back().error.mean.value, 1e-12);
  EXPECT_EQ(answers.pairs.size(), 3u);
  for (const Pair& pair : answers.pairs) EXPECT_GE(pair.difference.value, 0.0);
  EXPECT_FALSE(answers.worst.empty());
  EXPECT_FALSE(answers.worst.front().png.empty());
  const std::string page = sweepPage(answers, "test");
  EXPECT_EQ(page.find("{{"), std::string::npos);
  EXPECT_NE(page.find("data:image/png;base64,iVBOR"), std::string::npos);
  EXPECT_NE(answersLatex(answers).find("\\toprule"), std::string::npos);
  EXPECT_EQ(answersOf(store, {.scenes = {"corner"}}).table.scenes.size(), 1u);
  EXPECT_THROW(answersOf(store, {.scenes = {"cornr"}}), UsageError);
}

// A key says nothing of C++ code but by kCountsVersion.
TEST(Sweep, CountsChangeOnlyWithTheirVersion) {
  const TemporaryFolder folder;
  const fs::path db = folder.path() / "s.db", path = test::inSource("tests/lab/results_version.golden.txt");
  const SweepOutcome outcome = sweep(db, R"({"scenes": ["contact", "grate"], "size": "48", "repeats": 0,
    "maps": ["cube", "paraboloid", "spot", "directional"], "map_sizes": [48], "biases": ["all"],
    "worst_pictures": 0})");
  EXPECT_EQ(outcome.failed, 0u) << outcome.firstFailure;
  const Store store(db, sql::Open::Existing);
  if (store.database().integerOf("SELECT count(*) FROM results WHERE device NOT LIKE 'llvmpipe%'") > 0)
    GTEST_SKIP() << "other devices differ in a few pixels";
  std::string text = fmt::format("kCountsVersion {}\n", kCountsVersion);
  sql::Statement rows = store.database().prepare(
      "SELECT scene || ' ' || light || ' ' || map || ' ' || method || ': ' || scored || ' ' || acne || ' ' || leak || "
      "' ' || edge_shadow || ' ' || edge_light || ' ' || uncovered FROM results ORDER BY 1");
  while (rows.step()) text += rows.text(0) + "\n";
  if (std::getenv("GNOMON_BLESS") != nullptr) writeTextFile(path, text);
  EXPECT_EQ(readFile(path), text) << "where the shaders alone changed counts, tools/bless; where other code did, raise "
                                     "kCountsVersion (lab/sweep/results_version.h) and then tools/bless";
}

TEST(ResultsVersion, KnowsNoComments) {
  EXPECT_EQ(withoutComments("a  b // c\n\n  d /* e\n */ f\n#if 1 /* g */\n"), "a b\nd f\n#if 1\n");
  EXPECT_EQ(withoutComments("// a"), "");
  EXPECT_EQ(withoutComments("a/*"), "a ");
  EXPECT_NE(withoutComments("a+b"), withoutComments("a-b"));
}

TEST(RandomPlaces, AreTheSameForASeedAndSeeLight) {
  for (const char* name : {"atrium", "contact", "near-far"}) {
    const SetupOptions setup{.scene = name, .size = "32"};
    const Scene scene = openScene(setup);
    const Tracer tracer(scene);
    const std::vector<std::string> a = randomCameras(setup, tracer, scene.lights, 3, 5);
    ASSERT_EQ(a.size(), 3u) << name;
    EXPECT_EQ(a, randomCameras(setup, tracer, scene.lights, 3, 5));
    EXPECT_NE(a, randomCameras(setup, tracer, scene.lights, 3, 6));
    EXPECT_EQ(randomLights(tracer, 2, 5).size(), 2u) << name;
  }
}

}  // namespace
}  // namespace gnomon
