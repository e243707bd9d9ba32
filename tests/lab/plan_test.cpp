// Plans: what is read, where mistakes are said to be, and the published schema.
#include "lab/sweep/plan.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "lab/sweep/axes.h"
#include "lab/sweep/json_places.h"
#include "tests/base/places.h"
#include "tests/base/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

using test::TemporaryFolder;

constexpr const char* kGood = R"(// A comment
{
  "name": "a plan", /* another */
  "scenes": ["atrium", {"scene": "factory", "name": "hall"}],
  "cameras": ["default", {"random": 2}],
  "maps": ["cube", {"map": "directional", "options": {"warp": "lispsm"}}],
  "map_sizes": [64, 128],
  "biases": ["none", {"bias": "constant", "parameters": {"offset": [0.01, 0.02]}},
             {"bias": "slope", "tune": true}],
  "exclude": [{"scene": "hall", "map": "cube"}]
}
)";

std::string complaintAbout(const std::string& text) {
  try {
    axesOf(parsePlan("p.json", text));
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

std::string with(const std::string& what, const std::string& instead) {
  std::string text = kGood;
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), instead);
}

TEST(Plan, IsReadWithItsDefaults) {
  const Plan plan = parsePlan("p.json", kGood);
  EXPECT_EQ(plan.name, "a plan");
  EXPECT_EQ(plan.repeats, 3);
  ASSERT_EQ(plan.scenes.size(), 2u);
  EXPECT_EQ(plan.scenes[1].name, "hall");
  EXPECT_EQ(plan.cameras[1].random, 2);
  EXPECT_EQ(plan.lights.size(), 1u);
  const Axes axes = axesOf(plan);
  EXPECT_EQ(axes.maps.size(), 4u);  // two maps of two sizes
  ASSERT_EQ(axes.methods.size(), 4u);
  EXPECT_EQ(axes.methods[1].label, "constant offset=0.01");
  EXPECT_EQ(axes.methods[3].label, "slope tuned");
  EXPECT_TRUE(isExcluded(
      plan,
      {.scene = "hall", .light = "l", .camera = "c", .map = "cube", .bias = "none", .filter = "none", .mapSize = 64}));
  EXPECT_FALSE(isExcluded(plan, {.scene = "hall",
                                 .light = "l",
                                 .camera = "c",
                                 .map = "directional",
                                 .bias = "none",
                                 .filter = "none",
                                 .mapSize = 64}));
  EXPECT_FALSE(isExcluded(plan, {.scene = "hall", .light = "l", .camera = "c"}));  // only some of its cases
}

TEST(Plan, MistakesAreNamedWithTheirPlace) {
  const struct {
    const char* what;
    const char* instead;
    const char* complaint;
  } kMistakes[] = {
      {"\"atrium\"", "\"atrum\"",
       "p.json:4:14: scenes[0] 'atrum' is neither a file nor a generated scene; did you mean atrium?"},
      {"\"maps\"", "\"mapps\"", "p.json:6:12: mapps is no field here; did you mean maps?"},
      {"[64, 128]", "[64, 1]", "p.json:7:21: map_sizes[1] is 1, outside 2..16384"},
      {"[64, 128]", "[64, \"x\"]", "p.json:7:21: map_sizes[1] must be a whole number"},
      {"[64, 128]", "64", "p.json:7:16: map_sizes must be a list in brackets, and is 64"},
      {"\"lispsm\"", "\"lisp\"", "p.json:6:63: maps[1].options.warp is wrong"},
      {"\"warp\"", "\"wrap\"", "maps[1].options.wrap is no option of a directional map; did you mean warp?"},
      {"\"offset\"", "\"ofset\"", "biases[1].parameters.ofset is no parameter of constant; did you mean offset?"},
      {"0.02]", "-1]", "biases[1].parameters.offset is -1, outside"},
      {"\"slope\", \"tune\"", "\"witness\", \"tune\"", "biases[2].tune cannot tune witness: it has no parameter"},
      {"\"scene\": \"factory\", ", "", "p.json:4:24: scenes[1] lacks 'scene'"},
      {"{\"random\": 2}", "{\"random\": -2}", "p.json:5:37: cameras[1].random must be a whole number"},
      {"\"none\",", "\"none\" \"adaptive\",", "p.json:8:30: is not JSON: syntax error"},
      {"\"a plan\"", "\"a plan\", \"name\": \"b\"", "name stands here twice"},
      {"\"hall\"", "\"atrium\"", "scenes[1] 'atrium' is the name of two scenes"},
      {"[64, 128]", "[]", "p.json:7:16: map_sizes are none; leave the field out, or give one"},
      {"{\"scene\": \"hall\"", "{\"scene\": \"hal*\", \"bias\": \"slop\"",
       "exclude[0].bias is slop, which leaves out nothing of the plan; did you mean slope?"},
      {"{\"scene\": \"hall\"", "{\"scene\": \"zzz*\"",
       "exclude[0].scene is zzz*, which leaves out nothing of the plan; choose from "},
      {"\"cube\",", "\"cub\",", "p.json:6:12: maps[0] is wrong: --maps cub: no such map; did you mean cube?"},
  };
  for (const auto& [what, instead, complaint] : kMistakes) {
    const std::string said = complaintAbout(with(what, instead));
    EXPECT_NE(said.find(complaint), std::string::npos) << complaint << "\n" << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
  EXPECT_EQ(complaintAbout(kGood), "");
}

TEST(Plan, FilesAreFoundByPatternsFromThePlansFolder) {
  const TemporaryFolder folder;
  for (const char* name : {"a.glb", "b.glb", "c.txt"}) writeTextFile(folder.path() / name, "");
  const Plan plan = parsePlan(folder.path() / "p.json",
                              R"({"scenes": ["*.glb", "generated:t*"], "maps": ["cube"], "biases": ["none"]})");
  const Axes axes = axesOf(plan);
  ASSERT_EQ(axes.scenes.size(), 3u);
  EXPECT_EQ(axes.scenes[0].name, "a");
  EXPECT_EQ(axes.scenes[1].setup.scene, (folder.path() / "b.glb").string());
  EXPECT_EQ(axes.scenes[2].name, "tilted-planes");
}

TEST(Plan, PublishedSchemaIsTheOneOfTheFields) {
  const std::filesystem::path path = test::inSource("docs/plan.schema.json");
  if (std::getenv("GNOMON_BLESS") != nullptr) writeTextFile(path, planJsonSchema());
  EXPECT_EQ(readFile(path), planJsonSchema()) << "tools/bless writes it anew";
}

TEST(Plan, DamagedOnesAreRefusedInOneLineOrRead) {
  // Every prefix, and every byte replaced by what JSON is made of.
  const std::string good = kGood;
  const auto expectOneLine = [](const std::string& text) {
    try {
      parsePlan("p.json", text);
    } catch (const WorldError& error) {
      EXPECT_EQ(printable(error.what()), error.what());
      EXPECT_TRUE(std::string_view(error.what()).starts_with("p.json:")) << error.what();
    }
  };
  for (size_t length = 0; length < good.size(); ++length) expectOneLine(good.substr(0, length));
  for (size_t at = 0; at < good.size(); ++at)
    for (const char c : {'"', '{', ']', '\\', '\n', '\0', '/', '\xff', '9'}) {
      std::string bad = good;
      bad[at] = c;
      expectOneLine(bad);
    }
  expectOneLine(std::string(100000, '['));
}

TEST(JsonPlaces, AreThoseOfTheValues) {
  const std::string text = "{\"a\": [1, {\"b c\": /* x */ \"]\\\"\"}],\n \"d\": true}";
  const JsonPlaces places = placesInJson(text);
  const auto at = [&](const std::string& path) {
    for (const auto& [name, offset] : places.offsets)
      if (name == path) return text.substr(offset, 4);
    return std::string("?");
  };
  EXPECT_EQ(at("a[1].b c"), "\"]\\\"");
  EXPECT_EQ(at("d"), "true");
  const LineAndColumn place = lineAndColumn("\xC3\xA4\n\xC3\xA4x", 5);
  EXPECT_EQ(place.line, 2u);
  EXPECT_EQ(place.column, 2u);
}

}  // namespace
}  // namespace gnomon
