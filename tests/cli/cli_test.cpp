// The program: exit codes, one clear line for every mistake, and files that are whole or absent.
#include "base/file.h"
#include "lab/core/maps.h"
#include "tests/base/temporary_folder.h"

#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

struct Result {
  int exitCode = -1;
  std::string out;
  std::string err;
};

class CliTest : public ::testing::Test {
 protected:
  // `@` in the arguments stands for this test's folder.
  Result run(std::string arguments) const {
    for (size_t at = arguments.find('@'); at != std::string::npos; at = arguments.find('@'))
      arguments.replace(at, 1, folder_.string());
    const std::string command = std::string(GNOMON_PROGRAM) + " " + arguments + " >" + (folder_ / "stdout").string() +
                                " 2>" + (folder_ / "stderr").string() + " </dev/null";
    const int status = std::system(command.c_str());
    Result result{.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
                  .out = readFile(folder_ / "stdout"),
                  .err = readFile(folder_ / "stderr")};
    fs::remove(folder_ / "stdout");
    fs::remove(folder_ / "stderr");
    return result;
  }

  // Exit code, and a single line on stderr that holds `what`.
  void expectMistake(const std::string& arguments, int exitCode, const std::string& what) const {
    const Result result = run(arguments);
    EXPECT_EQ(result.exitCode, exitCode) << arguments << "\n" << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << arguments << "\n" << result.err;
  }

  size_t fileCount() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  const test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

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

// What does not depend on the clock, nor on where pictures went.
nlohmann::json withoutTimes(nlohmann::json row) {
  for (const char* key : {"build_ms", "shade_ms", "frame_ms", "pictures"}) row.erase(key);
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
      "none,bilinear --fit tight --snap off --cascades 2 --cube-depth radial --cube-passes six --paraboloid-axis "
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

TEST_F(CliTest, AReportOfNothingOrOfGarbageIsRefusedInOneLine) {
  fs::create_directory(folder_ / "run");
  expectMistake("report", 2, "DIR");
  expectMistake("report @/run", 2, "--out");
  expectMistake("report @/nowhere -o @/a.html", 1, "nowhere/results.json: does not exist");
  expectMistake("report @/run -o @/a.html", 1, "results.json: does not exist");
  writeTextFile(folder_ / "run" / "results.json", "{\"schema\": 2");
  expectMistake("report @/run -o @/a.html", 1, "run/results.json: is not JSON");
  writeTextFile(folder_ / "run" / "results.json", "{\"schema\": 99}");
  expectMistake("report @/run -o @/a.html", 1, "run/results.json: has schema 99");
  writeTextFile(folder_ / "run" / "results.json", "{\"schema\": 2}");
  expectMistake("report @/run -o @/a.html", 1, "run/results.json: gnomon is missing");
  EXPECT_EQ(fileCount(), 1u);
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

TEST_F(CliTest, ReproduceRefusesWhatItCannotRunInOneLine) {
  expectMistake("reproduce", 2, "PAPER");
  expectMistake("reproduce williams1978", 2, "no such paper; choose from weiskopf2003, dou2014");
  expectMistake("reproduce dou2014 --scale 7", 2, "--scale 7 is outside 0.05..1");
  expectMistake("reproduce dou2014 --repeats 0", 2, "--repeats");
  expectMistake("reproduce weiskopf2003 --scene @/nowhere.glb -o @/out", 1, "nowhere.glb");
  EXPECT_EQ(fileCount(), 0u);
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
  expectMistake("compare corner --bias-file @/two.glsl --bias-file-knob reach=much", 2, "'much' is not a number");
  expectMistake("compare corner --bias-file @/two.glsl --bias-file-knob reach=9", 2,
                "--bias-file-knob reach 9 is outside 0..8 texels");
}

TEST_F(CliTest, AShadowVolumeLeavesOutWhatMeansNothingOnItAndSaysSo) {
  const Result result =
      run("compare contact --maps vsv --biases none,slope,adaptive --vsv-size 64x64x128 --size 32 --repeats 1");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("skips slope"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("vsv 64x64x128"), std::string::npos) << result.out;
  const Result tooLarge = run("compare contact --maps vsv --biases none --vsv-size 4096x4096x4096 --size 32");
  EXPECT_EQ(tooLarge.exitCode, 1);
  EXPECT_NE(tooLarge.err.find("would fit"), std::string::npos) << tooLarge.err;
}

TEST_F(CliTest, MapTexelsPicksTheSide) {
  const Result result = run("compare corner --biases none --map-texels 10000 --size 32 --repeats 1 --json @/r.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(readFile(folder_ / "r.json")).at("rows")[0].at("map_size"), 100);
}

TEST_F(CliTest, AThresholdThatIsCrossedExitsWith3) {
  const std::string base = "compare tilted-planes --biases none,adaptive --size 64 --map-size 64 --repeats 1 ";
  const Result crossed = run(base + "--fail-if 'none:acne>1%'");
  EXPECT_EQ(crossed.exitCode, 3);
  EXPECT_NE(crossed.err.find("spot none: acne is"), std::string::npos) << crossed.err;
  EXPECT_EQ(run(base + "--fail-if 'adaptive:acne>0' --fail-if 'adaptive:leak>0'").exitCode, 0);
}

TEST_F(CliTest, WrongUsageExitsWith2AndOneLine) {
  expectMistake("", 2, "subcommand");
  expectMistake("compare", 2, "SCENE");
  expectMistake("compare contact --maps disc", 2, "--maps disc: no such map");
  expectMistake("compare contact --biases adaptve", 2, "adaptve: no such bias");
  expectMistake("compare contact --maps vsv --biases slope,dual", 2,
                "--maps vsv supports none of these --biases; choose from none, constant, adaptive");
  expectMistake("compare contact --maps vsv --biases none --filters bilinear", 2, "--maps vsv supports no filter");
  expectMistake("compare contact --maps vsv --vsv-size 64x64x100", 2, "--vsv-size 64x64x100");
  expectMistake("compare contact --maps vsv --vsv-source cube", 2, "--vsv-source cube");
  expectMistake("compare contact --maps vsv --vsv-fit tight", 2, "--vsv-fit tight");
  expectMistake("compare contact --size 0", 2, "--size 0");
  expectMistake("compare contact --map-size 1", 2, "2..16384");
  expectMistake("compare contact --map-size 64 --map-texels 4096", 2, "excludes");
  expectMistake("compare contact --constant-offset -1", 2, "--constant-offset");
  expectMistake("compare contact --constant-offset nan", 2, "--constant-offset");
  expectMistake("compare contact --fail-if acne", 2, "--fail-if 'acne'");
  expectMistake("compare contact --camera eye:1,2", 2, "--camera");
  expectMistake("compare contact --cone 300", 2, "--cone 300");
  expectMistake("compare contact --cull all", 2, "--cull all");
  expectMistake("compare contact --fit wide", 2, "--fit wide: no such choice");
  expectMistake("compare contact --snap yes", 2, "--snap yes: no such choice");
  expectMistake("compare contact --warp fish", 2, "--warp fish: no such choice");
  expectMistake("compare contact --cascades two", 2, "--cascades two: write a whole number of 1..4");
  expectMistake("compare contact --cube-depth cubic", 2, "--cube-depth cubic: no such choice; choose from hyperbolic");
  expectMistake("compare contact --cube-passes 6", 2, "--cube-passes 6: no such choice");
  expectMistake("compare contact --paraboloid-raster no", 2, "--paraboloid-raster no: no such choice");
  expectMistake("compare contact --paraboloid-axis 1,2", 2, "--paraboloid-axis 1,2: write three numbers, x,y,z");
  expectMistake("compare contact --paraboloid-axis 0,0,0", 2, "--paraboloid-axis 0,0,0 has no direction");
  expectMistake("compare contact --cascades 5", 2, "--cascades 5: is outside 1..4");
  expectMistake("compare contact --cascades 2 --warp tsm", 2, "--cascades 2 with --warp tsm");
  expectMistake("compare contact --repeats 0", 2, "--repeats");
  expectMistake("compare contact --no-such-flag", 2, "--no-such-flag");
  expectMistake("render contact -o @/a.jpg", 2, "the name must end in .png or .exr");
  expectMistake("render contact --biases all -o @/a.png", 2, "one configuration");
  expectMistake("fog grate --integrators rays", 2, "--integrators rays");
  expectMistake("fog grate --steps 0", 2, "--steps 0");
  expectMistake("fog grate --steps 3.5", 2, "--steps 3.5");
  expectMistake("fog grate --march-map spot", 2, "--march-map spot: choose cube or paraboloid");
  expectMistake("fog grate --sigma-s 1,2", 2, "--sigma-s 1,2: write one number or r,g,b");
  expectMistake("fog grate --sigma-a -1", 2, "--sigma-a -1");
  expectMistake("fog grate --sigma-s nan", 2, "--sigma-s nan");
  expectMistake("fog grate --g 1", 2, "--g 1");
  expectMistake("fog grate --reach 0", 2, "--reach 0");
  expectMistake("fog grate --bound 0", 2, "--bound 0");
  expectMistake("fog grate --density-scale 2", 2, "need a --density");
  expectMistake("fog grate --frames 3", 2, "--frames and --move: give both or neither");
  expectMistake("fog grate --frames 3 --move sun:1,0,0", 2, "--move sun:1,0,0");
  expectMistake("fog grate --frames 3 --move light:1,0,0", 2, "give a folder with -o");
  expectMistake("scene tilted-planes", 2, "-o FILE.glb");
  expectMistake("scene tilted-planes -o @/a.obj", 2, "the name must end in .glb");
  EXPECT_EQ(fileCount(), 0u);
}

TEST_F(CliTest, TheWorldsFailuresExitWith1AndOneLine) {
  expectMistake("compare nowhere.glb", 1, "nowhere.glb");
  expectMistake("compare contact --light moon --size 16", 1, "--light moon: the scene has no light of this name");
  expectMistake("compare contact --camera x --size 16", 1, "--camera x: the scene has no camera of this name");
  expectMistake("compare contact --device Voodoo2 --size 16", 1, "Voodoo2");
  expectMistake("compare contact --camera eye:0,1000,0,target:0,2000,0 --size 16", 1, "the camera sees no surface");
  expectMistake("render contact --size 16 --map-size 16 -o /proc/nowhere/a.png", 1, "/proc/nowhere");
  expectMistake("fog grate --density @/none.vdb --size 16", 1, "none.vdb");
  expectMistake("fog atrium --light moon --size 16", 1, "--light moon");
  expectMistake("fog grate --light 0,1,5 --camera eye:0,1,5,target:0,0,0 --size 16", 1, "stands at the camera's eye");
  expectMistake("scene nothing -o @/a.glb", 1, "nothing");
  expectMistake("scene --density steam -o @/a.vdb", 2, "choose from puff, fog, turbulence");
  expectMistake("scene --density puff", 2, "-o FILE.vdb");
  expectMistake("scene --density puff -o @/a.glb", 2, "the name must end in .vdb");
  expectMistake("scene grate --density puff -o @/a.vdb", 2, "--for grate");
  expectMistake("scene --density puff --for nothing -o @/a.vdb", 1, "nothing");
  expectMistake("compare contact --shader-dir @/none --size 16", 1, "none");
  EXPECT_EQ(fileCount(), 0u);
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
      const Result result =
          run("render contact --size 48 --map-size 32 --show " + show + " -o @/" + show + std::string(extension));
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

TEST_F(CliTest, VsvSaysWhatIsWrong) {
  expectMistake("vsv contact --vsv-size 64x64", 2, "--vsv-size");
  expectMistake("vsv contact --vsv-source map", 2, "--vsv-source map");
  expectMistake("vsv contact --vsv-fit tight", 2, "--vsv-fit tight");
  expectMistake("vsv contact --vdb @/v.nvdb", 2, "the name must end in .vdb");
  expectMistake("vsv contact --vdb-voxel 1", 2, "--vdb-voxel needs a --vdb");
  expectMistake("vsv contact --vdb @/v.vdb --vdb-voxel nan", 2, "--vdb-voxel");
  const std::string small = "vsv contact --vsv-size 64x64x128 --size 16 ";
  expectMistake(small + "--vdb @/v.vdb --vdb-voxel 1e-5", 2, "--vdb-voxel 1e-05");
  expectMistake(small + "--vdb /proc/nowhere/v.vdb", 1, "/proc/nowhere");
  expectMistake(small + "--vdb /dev/null/v.vdb", 1, "/dev/null");
  expectMistake("vsv contact --vsv-size 8192x8192x8192 --size 16", 1, "would fit");
  EXPECT_EQ(fileCount(), 0u);
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

}  // namespace
}  // namespace gnomon
