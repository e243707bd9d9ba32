// The program: what its verbs print and write, and files that are whole or absent.
#include "lab/core/maps.h"

#include "cli_fixture.h"

#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using test::CliTest;
using test::Result;

TEST_F(CliTest, CompareWritesATableResultsAndPicturesAndNoMessageOfValidation) {
  const Result result =
      run("compare contact --maps spot,directional --biases none,constant,slope,adaptive --size 96 "
          "--map-size 64 --repeats 1 -o @/out --json @/r.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("bias error"), std::string::npos);
  const auto json = nlohmann::json::parse(readFile(folder_ / "r.json"));
  EXPECT_EQ(readFile(folder_ / "r.json"), readFile(folder_ / "out" / "results.json"));
  EXPECT_EQ(json.at("rows").size(), 8u);
  EXPECT_TRUE(fs::exists(folder_ / "out" / "spot" / "adaptive.labels.png"));
  EXPECT_TRUE(fs::exists(folder_ / "out" / "directional" / "depth.exr"));
}

TEST_F(CliTest, CompareLeavesAPageAndReportMakesTheSameOneAgain) {
  const Result compared = run("compare corner --biases none,adaptive --size 32 --map-size 32 --repeats 1 -o @/out");
  ASSERT_EQ(compared.exitCode, 0) << compared.err;
  EXPECT_NE(compared.out.find("out/report.html"), std::string::npos) << compared.out;
  const Result reported = run("report @/out -o @/page.html");
  EXPECT_EQ(reported.exitCode, 0) << reported.err;
  EXPECT_NE(reported.out.find("page.html"), std::string::npos);
  const std::string page = readFile(folder_ / "page.html");
  EXPECT_TRUE(page.starts_with("<!doctype html>"));
  EXPECT_EQ(page, readFile(folder_ / "out" / "report.html"));
}

TEST_F(CliTest, AFolderHoldsOneRunAndReportRefusesAnother) {
  const std::string small = " --size 32 --map-size 32 --repeats 1 -o @/";
  ASSERT_EQ(run("compare corner --maps spot,cube --biases none,adaptive" + small + "out").exitCode, 0);
  ASSERT_EQ(run("compare corner --maps spot --biases none" + small + "out").exitCode, 0);
  EXPECT_FALSE(fs::exists(folder_ / "out" / "cube"));
  EXPECT_FALSE(fs::exists(folder_ / "out" / "spot" / "adaptive.beauty.png"));
  // A run that fails half-way leaves what there was.
  const std::string before = readFile(folder_ / "out" / "results.json");
  expectMistake("compare corner --camera eye:0,1000,0,target:0,2000,0" + small + "out", 1, "sees no surface");
  EXPECT_EQ(readFile(folder_ / "out" / "results.json"), before);
  EXPECT_EQ(run("report @/out -o @/a.html").exitCode, 0);

  ASSERT_EQ(run("compare contact --maps spot --biases none" + small + "other").exitCode, 0);
  fs::copy_file(folder_ / "other" / "spot" / "none.exr", folder_ / "out" / "spot" / "none.exr",
                fs::copy_options::overwrite_existing);
  expectMistake("report @/out -o @/b.html", 1, "out/spot/none.exr: is not the one that results.json lists");
  EXPECT_FALSE(fs::exists(folder_ / "b.html"));
}

TEST_F(CliTest, AMinusIsStandardOutputAndTheTableGoesElsewhere) {
  const Result json = run("compare corner --biases none --size 32 --map-size 32 --repeats 1 --json -");
  ASSERT_EQ(json.exitCode, 0) << json.err;
  EXPECT_EQ(nlohmann::json::parse(json.out).at("rows").size(), 1u);
  EXPECT_NE(json.err.find("bias error"), std::string::npos);
  const Result picture = run("render corner --size 32 --map-size 32 -o -");
  EXPECT_TRUE(picture.out.starts_with("\x89PNG")) << picture.err;
  EXPECT_TRUE(run("scene corner -o -").out.starts_with("glTF"));
  EXPECT_TRUE(run("scene --density puff -o -").out.starts_with(" BDV"));
}

// Of the commands that a page shows for its rows, as a person would copy them.
std::vector<std::string> rowCommandsOf(std::string page) {
  const std::string before = "<h3>Command for this row</h3>\n<div class=\"command\"><code>";
  std::vector<std::string> commands;
  for (size_t at = page.find(before); at != std::string::npos; at = page.find(before, at)) {
    at += before.size();
    std::string command = page.substr(at, page.find("</code>", at) - at);
    for (const auto& [escaped, character] :
         {std::pair{"&apos;", "'"}, {"&quot;", "\""}, {"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}})
      for (size_t found = command.find(escaped); found != std::string::npos; found = command.find(escaped))
        command.replace(found, std::string(escaped).size(), character);
    commands.push_back(command);
  }
  return commands;
}

// What does not depend on the clock, nor on where pictures went, nor on the other rows: the best one alone has
// `elsewhere`.
nlohmann::json withoutTimes(nlohmann::json row) {
  for (const char* key : {"build_ms", "shade_ms", "frame_ms", "pictures", "elsewhere"}) row.erase(key);
  return row;
}

TEST_F(CliTest, ThePagesCommandsMakeItsRowsAgainWhateverTheOptions) {
  writeTextFile(
      folder_ / "my biases" / "mine.glsl",
      "GNOMON_FN bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) { return true; }\n");
  const std::string setup =
      "compare contact --light 1,4,2 --camera eye:3,3,4,target:0,0.5,0,fov:50 --direction -1,-4,-2 --cone 75.5 "
      "--size 48x40 --map-size 64 --cull none --epsilon-at stored --repeats 1 -o @/out ";
  const std::string flags[] = {
      "--maps directional,cube,paraboloid,vsv --biases constant,adaptive --constant-offset 0.03 --filters "
      "none,bilinear --fit tight --snap off --cascades 2 --cube-depth radial --depth-range 0.05,30 --cube-passes six "
      "--paraboloid-axis "
      "0.3,-1,0.2 --paraboloid-raster tessellated --vsv-size 64x64x128 --vsv-source resample --vsv-fit full",
      "--maps spot,directional --warp lispsm --biases none,adaptive-ehm --adaptive-k 0.0003 --bias-file '@/my "
      "biases/mine.glsl'"};
  for (const MapOption* option : allMapOptions())
    EXPECT_NE((flags[0] + flags[1]).find(option->flag() + " "), std::string::npos)
        << option->flag() << " is at its default in this test";
  for (const std::string& chosen : flags) {
    const Result compared = run(setup + chosen);
    ASSERT_EQ(compared.exitCode, 0) << compared.err;
    const auto rows = nlohmann::json::parse(readFile(folder_ / "out" / "results.json")).at("rows");
    const std::vector<std::string> commands = rowCommandsOf(readFile(folder_ / "out" / "report.html"));
    ASSERT_EQ(commands.size(), rows.size());
    size_t same = 0;
    for (const std::string& command : commands) {
      const Result again = run(command.substr(std::string("gnomon ").size()) + " --repeats 1 --json @/row.json");
      ASSERT_EQ(again.exitCode, 0) << command << "\n" << again.err;
      const auto made = nlohmann::json::parse(readFile(folder_ / "row.json")).at("rows");
      for (const auto& row : rows) {
        if (row.at("command") != command) continue;
        ++same;
        EXPECT_EQ(std::ranges::count_if(made, [&](const auto& m) { return withoutTimes(m) == withoutTimes(row); }), 1)
            << row.dump(2) << "\n"
            << made.dump(2);
      }
    }
    EXPECT_EQ(same, rows.size());
  }
}

TEST_F(CliTest, FogWritesATableResultsPicturesAndAPage) {
  const std::string small = " --size 48 --vsv-size 128x128x128 --map-size 128 --repeats 1 ";
  const Result result = run("fog grate --truth --bound 0.01 --no-cache --steps 8,32 -o @/out --json @/r.json" + small);
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("march 32"), std::string::npos) << result.out;
  const auto json = nlohmann::json::parse(readFile(folder_ / "r.json"));
  EXPECT_EQ(readFile(folder_ / "r.json"), readFile(folder_ / "out" / "results.json"));
  EXPECT_EQ(json.at("media").size(), 5u);
  EXPECT_LT(json.at("media")[0].at("rel_rmse_99"), 0.1);
  EXPECT_TRUE(fs::exists(folder_ / "out" / "report.html"));
  EXPECT_TRUE(fs::exists(folder_ / "out" / "media" / "reference.exr"));
  ASSERT_EQ(run("report @/out -o @/again.html").exitCode, 0);
  EXPECT_EQ(readFile(folder_ / "again.html"), readFile(folder_ / "out" / "report.html"));
  // What is wrong in a medium's results is named.
  auto broken = json;
  broken["media"][1].erase("integrate_ms");
  writeTextFile(folder_ / "out" / "results.json", broken.dump());
  expectMistake("report @/out -o @/b.html", 1, "media[1].integrate_ms is missing");

  ASSERT_EQ(run("fog grate -o @/a.exr" + small).exitCode, 0);
  ASSERT_EQ(run("fog grate -o @/a.png --truth --bound 0.1 --integrators march --steps 8 --march-map paraboloid" + small)
                .exitCode,
            0);
  EXPECT_TRUE(fs::exists(folder_ / "a.exr") && fs::exists(folder_ / "a.png") &&
              fs::exists(folder_ / "a.reference.png"));
}

TEST_F(CliTest, FogMarchesADensity) {
  ASSERT_EQ(run("scene --density puff --for grate -o @/puff.vdb").exitCode, 0);
  const Result result =
      run("fog grate --density @/puff.vdb --steps 16 --size 24 --truth --bound 0.05 --vsv-size "
          "64x64x128 --map-size 64 --repeats 1 --json @/r.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto json = nlohmann::json::parse(readFile(folder_ / "r.json"));
  ASSERT_EQ(json.at("media").size(), 2u);
  EXPECT_EQ(json.at("media")[0].at("integrator"), "bits");
  EXPECT_EQ(json.at("media")[0].at("steps"), 16);
  EXPECT_LT(json.at("media")[0].at("rel_rmse_99"), 0.5);
  EXPECT_FALSE(json.at("medium").at("density").is_null());
}

TEST_F(CliTest, EveryBiasKnobIsAFlag) {
  const Result result =
      run("compare corner --biases constant,adaptive --constant-offset 0.125 --adaptive-k 0.002 --epsilon-at "
          "stored --size 32 "
          "--map-size 32 --repeats 1 --cull none --json @/r.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto rows = nlohmann::json::parse(readFile(folder_ / "r.json")).at("rows");
  EXPECT_EQ(rows[0].at("params").at("offset"), 0.125);
  EXPECT_EQ(rows[1].at("params").at("k"), 0.002);
  EXPECT_EQ(rows[1].at("params").at("epsilon_at"), "stored");
  EXPECT_EQ(rows[1].at("params").at("cull"), "none");
}

TEST_F(CliTest, AFiltersKnobIsAFlag) {
  const Result result = run(
      "compare corner --biases none --filters none,jitter4x4 --jitter4x4-width 6 --size 32 --map-size 32 --repeats 1 "
      "--json @/r.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto rows = nlohmann::json::parse(readFile(folder_ / "r.json")).at("rows");
  EXPECT_FALSE(rows[0].at("params").contains("filter_width"));
  EXPECT_EQ(rows[1].at("params").at("filter_width"), 6);
}

TEST_F(CliTest, AFilesKnobsAreSetByName) {
  const char* lit = "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) { return true; }\n";
  writeTextFile(folder_ / "one.glsl", std::string("//! knob: reach texels 0 8 1\n") + lit);
  writeTextFile(folder_ / "two.glsl",
                std::string("//! knob: reach texels 0 8 1\n//! knob: offset metres 0 9 1\n") + lit);
  writeTextFile(folder_ / "plain.glsl", lit);
  const std::string small = " --biases none --size 32 --map-size 32 --repeats 1 --json @/r.json";
  ASSERT_EQ(
      run("compare corner --bias-file @/one.glsl --bias-file @/two.glsl --bias-file @/plain.glsl --bias-file-knob "
          "reach=2 --bias-file-knob offset=3" +
          small)
          .exitCode,
      0);
  auto rows = nlohmann::json::parse(readFile(folder_ / "r.json")).at("rows");
  EXPECT_EQ(rows[1].at("params").at("reach"), 2);
  EXPECT_EQ(rows[2].at("params").at("reach"), 2);
  EXPECT_EQ(rows[2].at("params").at("offset"), 3);
  ASSERT_EQ(run("compare corner --bias-file @/one.glsl --bias-file-knob 4" + small).exitCode, 0);
  rows = nlohmann::json::parse(readFile(folder_ / "r.json")).at("rows");
  EXPECT_EQ(rows[1].at("params").at("reach"), 4);

  expectMistake("compare corner --bias-file-knob 4", 2, "--bias-file-knob needs a --bias-file");
  expectMistake("compare corner --bias-file @/two.glsl --bias-file-knob 4", 2,
                "two.glsl has 2 parameters; write NAME=VALUE, where NAME is one of reach, offset");
  expectMistake("compare corner --bias-file @/plain.glsl --bias-file-knob 4", 2, "plain.glsl has no parameter");
  expectMistake("compare corner --bias-file @/two.glsl --bias-file-knob rich=4", 2,
                "--bias-file-knob rich=4: no such parameter; choose from reach, offset");
  expectMistake("compare corner --bias-file @/one.glsl --bias-file @/two.glsl --bias-file-knob rich=4", 2,
                "no such parameter; choose from reach, offset");
  expectMistake("compare corner --bias-file @/two.glsl --bias-file-knob reach=much", 2, "'much' is not a number");
  expectMistake("compare corner --bias-file @/two.glsl --bias-file-knob reach=9", 2,
                "--bias-file-knob reach 9 is outside 0..8 texels");
  // Where --biases names it, too.
  ASSERT_EQ(run("compare corner --bias-file @/one.glsl --biases one,none --size 32 --map-size 32 --repeats 1 --json "
                "@/r.json")
                .exitCode,
            0);
  rows = nlohmann::json::parse(readFile(folder_ / "r.json")).at("rows");
  EXPECT_EQ(rows[0].at("bias"), "one");
  EXPECT_EQ(rows[1].at("bias"), "none");
  expectMistake("render corner --bias-file @/one.glsl --biases none -o @/x.png", 2, "render draws one configuration");
  EXPECT_EQ(run("render corner --bias-file @/one.glsl --size 32 --map-size 32 -o @/x.png").exitCode, 0);
}

TEST_F(CliTest, ComparePrintsARecommendationAndKeepsToTheTerminalsWidth) {
  const std::string base = "compare contact --biases none,slope,dual --size 64 --map-size 64 --repeats 1 ";
  const Result usual = run(base + "--json @/r.json");
  ASSERT_EQ(usual.exitCode, 0) << usual.err;
  EXPECT_NE(usual.out.find("\nUse "), std::string::npos) << usual.out;
  EXPECT_NE(usual.out.find("\n  elsewhere: from camera "), std::string::npos) << usual.out;
  EXPECT_EQ(usual.out.find("agree"), std::string::npos);
  EXPECT_NE(run(base + "--wide").out.find(" agree"), std::string::npos);
  const auto json = nlohmann::json::parse(readFile(folder_ / "r.json"));
  size_t recommended = 0;
  for (const auto& row : json.at("rows")) recommended += row.at("elsewhere").is_null() ? 0 : 1;
  EXPECT_EQ(recommended, 1u);
  EXPECT_TRUE(json.at("equal_error").is_null());
  ASSERT_EQ(setenv("COLUMNS", "80", 1), 0);
  const Result narrow = run(base);
  ASSERT_EQ(unsetenv("COLUMNS"), 0);
  std::istringstream lines(narrow.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
  EXPECT_NE(narrow.out.find("all wrong"), std::string::npos);
}

TEST_F(CliTest, UntilErrorFindsTheSmallestMaps) {
  const Result result = run(
      "compare contact --biases none,slope --size 64 --map-size 32 --repeats 1 --until-error 2% --until-map-size 256 "
      "-o @/out");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.out.find("smallest map with at most 2% of all pixels wrong"), std::string::npos) << result.out;
  const auto equal = nlohmann::json::parse(readFile(folder_ / "out" / "results.json")).at("equal_error");
  EXPECT_EQ(equal.at("limit"), 0.02);
  EXPECT_EQ(equal.at("methods")[0].at("bias"), "slope");
  EXPECT_TRUE(equal.at("methods")[1].at("smallest").is_null());
  EXPECT_NE(readFile(folder_ / "out" / "report.html").find("Equal error"), std::string::npos);
  expectMistake("compare contact --until-error 2", 2, "--until-error 2: write a share of the pixels");
  expectMistake("compare contact --until-error 0", 2, "--until-error 0: write a share of the pixels between 0 and 1");
  expectMistake("compare contact --until-error much", 2, "--until-error much");
  expectMistake("compare contact --until-error 1% --until-map-size 1", 2, "--until-map-size");
}

TEST_F(CliTest, MapTexelsPicksTheSide) {
  const Result result =
      run("compare corner --maps spot --biases none --map-texels 10000 --size 32 --repeats 1 --json @/r.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(readFile(folder_ / "r.json")).at("rows")[0].at("map_size"), 100);
}

// The choices of a flag, which --help lists as {a,b,c} behind it.
std::vector<std::string> choicesOf(const std::string& help, const std::string& flag) {
  const size_t line = help.find("  " + flag + " ");
  const size_t begin = help.find('{', line), end = help.find('}', line);
  std::vector<std::string> choices;
  if (line == std::string::npos || end == std::string::npos ||
      help.substr(line, begin - line).find('\n') != std::string::npos)
    return choices;
  std::istringstream words(help.substr(begin + 1, end - begin - 1));
  for (std::string word; std::getline(words, word, ',');) choices.push_back(word);
  return choices;
}

// Every choice of --show that the program itself lists; and each is a picture of its own.
TEST_F(CliTest, RenderDrawsEveryKindOfPicture) {
  const std::vector<std::string> shows = choicesOf(run("render --help").out, "--show");
  ASSERT_GE(shows.size(), 9u);  // else --help was not understood
  std::set<std::string> pngs, exrs;
  for (const std::string& show : shows) {
    for (const char* extension : {".png", ".exr"}) {
      const Result result = run("render contact --maps spot --size 48 --map-size 32 --show " + show + " -o @/" + show +
                                std::string(extension));
      EXPECT_EQ(result.exitCode, 0) << show << extension << ": " << result.err;
    }
    EXPECT_TRUE(pngs.insert(readFile(folder_ / (show + ".png"))).second) << show << " is drawn as another";
    EXPECT_TRUE(exrs.insert(readFile(folder_ / (show + ".exr"))).second) << show << " is drawn as another";
  }
  EXPECT_EQ(fileCount(), 2 * shows.size());
}

// A generated scene, written and loaded again, is the same scene: the same counts for every bias.
TEST_F(CliTest, AnExportedSceneComparesEqual) {
  for (const std::string scene : {"contact", "sheets", "crowd:20000"}) {
    ASSERT_EQ(run("scene " + scene + " -o @/scene.glb").exitCode, 0);
    const std::string flags = " --biases none,second-depth,dual,adaptive --size 96 --map-size 64 --repeats 1 --json @/";
    ASSERT_EQ(run("compare " + scene + flags + "a.json").exitCode, 0);
    ASSERT_EQ(run("compare @/scene.glb" + flags + "b.json").exitCode, 0);
    auto a = nlohmann::json::parse(readFile(folder_ / "a.json"));
    auto b = nlohmann::json::parse(readFile(folder_ / "b.json"));
    ASSERT_EQ(a.at("rows").size(), b.at("rows").size());
    for (size_t i = 0; i < a.at("rows").size(); ++i)
      for (const char* key : {"scored", "agree", "acne", "leak", "edge_shadow", "edge_light", "uncovered", "params"})
        EXPECT_EQ(a["rows"][i].at(key), b["rows"][i].at(key)) << scene << " " << key;
    EXPECT_EQ(a.at("scene").at("sceneScale"), b.at("scene").at("sceneScale"));
  }
}

TEST_F(CliTest, VsvValidatesAndWritesAVolume) {
  const Result result =
      run("vsv contact --validate --vsv-size 64x64x128 --vsv-source resample --map-size 64 --size 64 -o @/out "
          "--json @/v.json --vdb @/v.vdb");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto json = nlohmann::json::parse(readFile(folder_ / "v.json"));
  EXPECT_EQ(readFile(folder_ / "v.json"), readFile(folder_ / "out" / "volume.json"));
  EXPECT_EQ(json.at("same_map").at("mismatches"), 0);
  EXPECT_EQ(json.at("exact").at("columns"), 64 * 128);
  EXPECT_EQ(json.at("vdb").at("bytes"), fs::file_size(folder_ / "v.vdb"));
  EXPECT_EQ(readFile(folder_ / "v.vdb").substr(0, 4), " BDV");
  for (const char* picture : {"slice_alpha", "slice_theta", "slice_phi", "coordinates"})
    EXPECT_TRUE(fs::exists(folder_ / "out" / (std::string(picture) + ".png"))) << picture;
}

TEST_F(CliTest, SceneListsAndInfoTells) {
  const Result scenes = run("scene");
  for (const char* density : {"puff", "fog", "turbulence"})
    EXPECT_NE(scenes.out.find(density), std::string::npos) << density;
  const Result puff = run("scene --density puff --for contact -o @/puff.vdb");
  EXPECT_EQ(puff.exitCode, 0) << puff.err;
  EXPECT_NE(puff.out.find("voxels of"), std::string::npos);
  for (const char* name :
       {"lshape", "double-torus", "factory", "atrium", "corner", "sheets", "contact", "tilted-planes", "crowd"})
    EXPECT_NE(scenes.out.find(name), std::string::npos) << name;
  const Result info = run("info lshape");
  EXPECT_NE(info.out.find("solid"), std::string::npos);
  EXPECT_NE(info.out.find("sheet"), std::string::npos);
  EXPECT_NE(run("info").out.find("Vulkan 1."), std::string::npos);
  EXPECT_EQ(run("--version").exitCode, 0);
  const Result help = run("compare --help");
  EXPECT_EQ(help.exitCode, 0);
  EXPECT_NE(help.out.find("--adaptive-k"), std::string::npos);
  for (const MapOption* option : allMapOptions())
    EXPECT_NE(help.out.find(option->flag() + " TEXT=" + option->defaultText()), std::string::npos) << option->flag();
}

TEST_F(CliTest, ExportWritesOneFileAndSaysWhatItCannot) {
  const Result glsl = run("export --map cube --bias slope --filter bilinear --slope-factor 3");
  EXPECT_EQ(glsl.exitCode, 0) << glsl.err;
  EXPECT_NE(glsl.out.find("const float kGnomonSlopeFactor = 3.0f;"), std::string::npos);
  EXPECT_NE(glsl.out.find("King, \"Shadow Mapping Algorithms\", 2004"), std::string::npos);  // the source
  EXPECT_NE(glsl.out.find("gnomonDepth (binding 0)"), std::string::npos);
  EXPECT_EQ(glsl.out.find("Adaptive"), std::string::npos);  // only what is used
  const Result hlsl = run("export contact --map spot --bias constant --lang hlsl -o @/shadow.hlsl");
  EXPECT_EQ(hlsl.exitCode, 0) << hlsl.err;
  EXPECT_NE(readFile(folder_ / "shadow.hlsl").find("the diagonal of `contact`"), std::string::npos);
  EXPECT_EQ(run("export --headers @/include").exitCode, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "include/gnomon/glsl/visibility.glsl"));
  expectMistake("export --map vsv", 2, "compute passes");
  expectMistake("export --bias slop", 2, "--bias slop: no such bias");
  expectMistake("export --filter soft", 2, "--filter soft: no such filter");
  expectMistake("export --row 2", 2, "--row needs --results");
  expectMistake("export --cascades 2", 2, "--cascades has no effect: the map cube has no such option");
  expectMistake("export --map spot --cube-depth radial", 2, "--cube-depth has no effect");
  expectMistake("export --bias constant --slope-factor 2", 2, "--slope-factor has no effect: the bias is constant");
  expectMistake("export --bias constant --witness-reach 4", 2, "--witness-reach has no effect");
  expectMistake("export --scene-index 0", 2, "--scene-index has no effect: no SCENE is given");
  expectMistake("export atrium --solids closed", 2, "--solids has no effect: no exported code depends on");
  expectMistake("export --headers @/include --map spot", 2, "--map has no effect: --headers writes all maps");
}

TEST_F(CliTest, ExportTakesARowOfResults) {
  ASSERT_EQ(run("compare contact --maps cube --size 64 --map-size 48 --biases none,constant --constant-offset 0.0625 "
                "--repeats 1 --quiet -o @/out")
                .exitCode,
            0);
  const Result row = run("export --results @/out --row 0 --lang glsl");  // the best, not the first that ran
  EXPECT_EQ(row.exitCode, 0) << row.err;
  EXPECT_NE(row.out.find("const float kGnomonConstantOffset = 0.0625f;"), std::string::npos) << row.out.substr(0, 3000);
  EXPECT_NE(row.out.find("const int kGnomonMapSide = 48;"), std::string::npos);
  expectMistake("export --results @/out --bias slope", 2, "the row of the results has it already");
  expectMistake("export --results @/out --row 7", 2, "has rows 0 to 1");
}

TEST_F(CliTest, ExportTakesARowOfOnesOwnBias) {
  writeTextFile(folder_ / "mine.glsl",
                "//! name: mine\n//! knob: offset metres 0 1 0.5\n"
                "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {\n"
                "  return depthTowardsLight(map, tap.slice, receiver.posL, tap.ray, params.knobs[kUserOffset]) <= "
                "tap.z1;\n}\n");
  writeTextFile(folder_ / "other.glsl",
                "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) "
                "{ return true; }\n");
  ASSERT_EQ(run("compare contact --maps cube --size 64 --map-size 48 --biases none --bias-file @/mine.glsl "
                "--bias-file-knob 0.0625 --repeats 1 --quiet -o @/out")
                .exitCode,
            0);
  const Result row = run("export --results @/out --bias-file @/mine.glsl");
  EXPECT_EQ(row.exitCode, 0) << row.err;
  EXPECT_NE(row.out.find("0.0625f"), std::string::npos) << row.out.substr(0, 3000);
  expectMistake("export --results @/out", 2, "--row 0 is of a bias of your own, mine: give its file with --bias-file");
  expectMistake("export --results @/out --bias-file @/other.glsl", 2, "and --row 0 is of mine");
  expectMistake("export --results @/out --row 1 --bias-file @/mine.glsl", 2, "row 1 is of none, which is Gnomon's");
}

TEST_F(CliTest, RenderLabelsAnotherRenderersVisibility) {
  ASSERT_EQ(run("render contact --maps cube --map-size 64 --size 64 --show truth -o @/truth.png --quiet").exitCode, 0);
  const Result exact = run(
      "render contact --maps cube --map-size 64 --size 64 --show labels --prediction @/truth.png -o @/l.png --quiet");
  EXPECT_EQ(exact.exitCode, 0);
  EXPECT_NE(exact.err.find("acne 0, leak 0, edge_shadow 0, edge_light 0"), std::string::npos) << exact.err;
  ASSERT_EQ(
      run("render contact --maps cube --map-size 64 --size 64 --biases none --show visibility -o @/none.png --quiet")
          .exitCode,
      0);
  const Result none = run(
      "render contact --maps cube --map-size 64 --size 64 --show labels --prediction @/none.png -o @/l.png --quiet");
  EXPECT_EQ(none.err.find("acne 0,"), std::string::npos) << none.err;
  expectMistake("render contact --size 32 --maps cube --show labels --prediction @/truth.png -o @/l.png", 2,
                "is 64 x 64 pixels, the picture 32 x 32");
  expectMistake("render contact --maps cube --prediction @/truth.png -o @/l.png", 2, "give --show labels");
}

}  // namespace
}  // namespace gnomon
