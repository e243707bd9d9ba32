// The bench: ratios are of one round, and its curves and numbers are all there.
#include "lab/bench/bench.h"
#include "base/error.h"
#include "lab/bench/bare_rays.h"
#include "lab/bench/plain_forward.h"
#include "omni/cube_map.h"
#include "vsv/volume_parameterization.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

// A machine that gets slower from round to round: ratios must not notice.
TEST(Bench, ARatioIsOfTheSameRound) {
  int round = 0;
  const std::vector<TimedStage> stages = {
      {"base", "", [&] { return 10.0 * ++round; }},
      {"twice", "base", [&] { return 20.0 * round; }},
      {"outlier", "base", [&] { return round == 3 ? 1e6 : 5.0 * round; }},
  };
  const std::vector<StageCost> costs = timeInRounds(stages, 5);  // rounds 2..6; the first is not timed
  ASSERT_EQ(costs.size(), 3u);
  EXPECT_DOUBLE_EQ(costs[0].medianMs, 40.0);
  EXPECT_DOUBLE_EQ(costs[0].minMs, 20.0);
  EXPECT_DOUBLE_EQ(costs[0].maxMs, 60.0);
  EXPECT_DOUBLE_EQ(costs[0].ratio, 0.0);
  EXPECT_DOUBLE_EQ(costs[1].ratio, 2.0);
  EXPECT_DOUBLE_EQ(costs[2].ratio, 0.5);
  EXPECT_DOUBLE_EQ(costs[2].maxMs, 1e6);
}

TEST(Bench, TheCurvesAreOneDrawingThatNamesEveryStageAndSize) {
  const Growth growth{.size = "pixels",
                      .unit = "pixels",
                      .stages = {"a <b>", "c"},
                      .points = {{1e4, "100", {1.0, 2.0}}, {1e6, "1000", {50.0, 2.5}}}};
  const std::string svg = growthSvg({growth, growth});
  EXPECT_EQ(svg.rfind("<svg ", 0), 0u);
  for (const char* text : {"a &lt;b&gt;", ">c<", ">100<", ">1000<", "milliseconds against pixels"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(growthSvg({}), "");
}

TEST(Bench, ChosenStagesComeWithWhatTheyAreComparedWith) {
  const auto run = [] { return 1.0; };
  const std::vector<TimedStage> stages = {
      {"limit", "", run}, {"map", "limit", run}, {"look", "map", run}, {"other", "limit", run}};
  const auto namesOf = [](const std::vector<TimedStage>& chosen) {
    std::string names;
    for (const TimedStage& stage : chosen) names += stage.name + " ";
    return names;
  };
  EXPECT_EQ(namesOf(chosenStages(stages, {})), "limit map look other ");
  EXPECT_EQ(namesOf(chosenStages(stages, {"loo"})), "limit map look ");
  EXPECT_EQ(namesOf(chosenStages(stages, {"oth", "map"})), "limit map other ");
  EXPECT_THROW(chosenStages(stages, {"nothing"}), UsageError);
}

// The limit is of the same shadow: as many rays are blocked as the exact shadow says, but for those that end on another
// surface within a ten-thousandth.
TEST(Bench, BareRaysAnswerTheSameQuestion) {
  const Session session({}, {.scene = "contact", .size = "128"});
  ShadowPasses passes(session);
  const LightOnMap cube = openLight(session, passes, cubeParameterization(), {.side = 64});
  BareRays rays(session.scene(), cube.light(), cube.receivers());
  EXPECT_EQ(rays.count(), cube.receivers().scored);
  rays.trace();
  const double shadowed = static_cast<double>(cube.receivers().scored - cube.truth().litCount);
  EXPECT_GT(shadowed, 500.0);
  EXPECT_NEAR(static_cast<double>(rays.occluded()), shadowed, 0.01 * shadowed);
}

// The baseline draws the scene that it is compared on: its picture is the frame pass's but for the headlight of the
// ambient light and what its own bias says.
TEST(Bench, ThePlainRendererDrawsTheSamePicture) {
  const Session session({}, {.scene = "contact", .size = "128"});
  ShadowPasses passes(session);
  LightOnMap cube = openLight(session, passes, cubeParameterization(), {.side = 256});
  const PlainForward plain(session, cube, 0.02f);
  gpu::Commands commands(session.device(), "plain");
  plain.recordMap(commands);
  commands.barrier("the plain cube is drawn -> the plain picture looks it up");
  plain.recordPicture(commands);
  commands.submitAndWait();
  const auto seen = gpu::downloadAs<glm::vec4>(session.device(), plain.picture());
  const ImageF ours = cube.picture(atDefaults(findBias("adaptive"), session));
  size_t surfaces = 0, alike = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    if (session.primitiveIds()[i].instancePlusOne == 0) continue;
    ++surfaces;
    alike += std::abs(seen[i].y - ours.values[3 * i + 1]) < 0.06f ? 1 : 0;
  }
  EXPECT_GT(surfaces, 8000u);
  EXPECT_GT(alike, surfaces * 95 / 100);
}

TEST(Bench, EveryStageOfASceneIsTimedAgainstOneThatIsThere) {
  const Session session({}, {.scene = "contact", .size = "32"});
  BenchOptions options{.mapTexels = 6 * 32 * 32, .repeats = 1, .growth = false};
  options.mapOptions.set(kVolumeSize({.alpha = 64, .theta = 64, .phi = 128}));
  Bench bench = runBench(session, {}, options);
  bench.growths.push_back({.size = "texels",
                           .unit = "texels",
                           .stages = {"in proportion to its square", "not at all"},
                           .points = {{10.0, "10", {1.0, 7.0}, {5.0, 3.0}},
                                      {100.0, "100", {2.0, 7.0}, {5.0, 3.0}},
                                      {1000.0, "1000", {200.0, 7.0}, {50.0, 3.0}}}});
  EXPECT_GT(bench.stages.size(), 50u);
  EXPECT_FALSE(bench.start.has_value());
  const auto json = nlohmann::json::parse(benchJson(session, bench, "gnomon bench contact"));
  std::set<std::string> names;
  size_t compared = 0;
  for (const auto& stage : json["stages"]) {
    EXPECT_TRUE(names.insert(stage["name"]).second) << stage;
    EXPECT_GT(stage["median_ms"].get<double>(), 0.0) << stage;
    EXPECT_LE(stage["min_ms"].get<double>(), stage["median_ms"].get<double>());
    EXPECT_GE(stage["max_ms"].get<double>(), stage["median_ms"].get<double>());
    if (!stage.contains("ratio")) continue;
    EXPECT_GT(stage["ratio"].get<double>(), 0.0) << stage;
    EXPECT_TRUE(names.contains(stage["ratio_to"])) << stage << " is compared with what comes later";
    ++compared;
  }
  EXPECT_GT(compared, names.size() / 2);
  for (const char* name : {"baseline/forward", "frame/cube/adaptive", "limit/rtcOccluded16", "limit/device copy 64 MiB",
                           "map/cube/two layers", "map/paraboloid, vertex/one layer", "visibility/cube/adaptive",
                           "volume/bits, one pass", "truth/exact shadow", "media/runs", "media/march 512 steps",
                           "decisions/cube, 8 biases", "truth/receivers, of one light"})
    EXPECT_TRUE(names.contains(name)) << name;
  const auto& growth = json["growth"][0];
  EXPECT_NEAR(growth["exponents"][0].get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(growth["cpu_exponents"][0].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(growth["exponents"][1].get<double>(), 0.0, 1e-9);
  EXPECT_EQ(growth["points"][2]["cpu_ms"][0], 50.0);
  EXPECT_NE(benchTable(session, bench).find("2.00    1.00"), std::string::npos) << benchTable(session, bench);
}

}  // namespace
}  // namespace gnomon
