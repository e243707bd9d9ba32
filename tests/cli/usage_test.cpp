// What people ask of the program besides its numbers: help, completion, a manual, its version; and the choices of
// scene, view and exposure.
#include "base/image.h"
#include "lab/core/maps.h"

#include "cli_fixture.h"

#include "tests/base/places.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::CliTest;
using test::Result;

bool has(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

bool isInstalled(const char* program) {
  return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}

class UsageTest : public CliTest {
 protected:
  // What bash offers after these words, with the script that the program writes.
  std::string offered(const std::string& words) const {
    writeTextFile(folder_ / "ask.bash",
                  ". '" + (folder_ / "gnomon.bash").string() + "'\nCOMP_WORDS=(" + words +
                      ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_gnomon\necho \"${COMPREPLY[*]}\"\n");
    const std::string answer = (folder_ / "answer").string();
    EXPECT_EQ(std::system(("bash '" + (folder_ / "ask.bash").string() + "' >'" + answer + "'").c_str()), 0);
    return readFile(answer);
  }

  mutable std::string told_;  // what was printed last

  json compared(const std::string& arguments) const {
    const Result result = run("compare " + arguments + " --size 64 --map-size 64 --repeats 1 --json @/r.json");
    EXPECT_EQ(result.exitCode, 0) << arguments << "\n" << result.err;
    return json::parse(readFile(folder_ / "r.json"));
  }
};

TEST_F(UsageTest, BashCompletesVerbsFlagsAndValues) {
  writeTextFile(folder_ / "gnomon.bash", run("completion bash").out);
  EXPECT_EQ(offered("gnomon comp"), "compare completion\n");
  EXPECT_EQ(offered("gnomon compare --cube-d"), "--cube-depth\n");
  EXPECT_EQ(offered("gnomon compare x --cube-depth r"), "radial\n");
  EXPECT_EQ(offered("gnomon compare x --maps cube,para"), "cube,paraboloid\n");
  EXPECT_EQ(offered("gnomon compare x --biases wit"), "witness\n");
  EXPECT_EQ(offered("gnomon render x --filters bili"), "bilinear\n");
  EXPECT_EQ(offered("gnomon compare x --solids ''"), "file closed auto\n");
  EXPECT_EQ(offered("gnomon fog atr"), "atrium\n");
  EXPECT_EQ(offered("gnomon reproduce dou"), "dou2014\n");
  writeTextFile(folder_ / "my file.glb", "");
  EXPECT_TRUE(has(offered("gnomon info '" + (folder_ / "my").string() + "'"), "my file.glb"));
}

TEST_F(UsageTest, EveryShellsScriptHasEveryFlagAndParses) {
  const std::string help = run("compare --help").out;
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const Result script = run(fmt::format("completion {}", shell));
    ASSERT_EQ(script.exitCode, 0);
    for (const Parameterization* map : parameterizations()) EXPECT_TRUE(has(script.out, map->name())) << shell;
    size_t flags = 0;
    for (size_t at = help.find("\n  --"); at != std::string::npos; at = help.find("\n  --", at + 1)) {
      const std::string flag = help.substr(at + 5, help.find_first_of(" ,\n", at + 5) - at - 5);
      EXPECT_TRUE(has(script.out, flag)) << shell << " lacks " << flag;
      ++flags;
    }
    EXPECT_GT(flags, 50u);
    writeTextFile(folder_ / shell, script.out);
    if (!isInstalled(shell)) continue;
    EXPECT_EQ(std::system(fmt::format("{} -n '{}'", shell, (folder_ / shell).string()).c_str()), 0) << shell;
  }
  expectMistake("completion tcsh", 2, "tcsh: no such choice");
}

TEST_F(UsageTest, TheManualHasEveryVerbAndIsGoodTroff) {
  const Result page = run("man");
  ASSERT_EQ(page.exitCode, 0);
  for (const char* what : {"gnomon compare", "gnomon fog", "gnomon completion", "Exit codes", "130 interrupted",
                           "\\-\\-until\\-error", "GNOMON_CACHE_DIR"})
    EXPECT_TRUE(has(page.out, what)) << what;
  if (!isInstalled("groff")) GTEST_SKIP() << "skipped: no groff here";
  writeTextFile(folder_ / "gnomon.1", page.out);
  EXPECT_EQ(std::system(("groff -man -ww -Tascii '" + (folder_ / "gnomon.1").string() + "' >'" +
                         (folder_ / "text").string() + "' 2>'" + (folder_ / "complaints").string() + "'")
                            .c_str()),
            0);
  EXPECT_EQ(readFile(folder_ / "complaints"), "");
  EXPECT_TRUE(has(readFile(folder_ / "text"), "130 interrupted"));
}

TEST_F(UsageTest, HelpIsGroupedAndEndsWithTheExitCodes) {
  const std::string help = run("compare --help").out;
  size_t at = 0;
  for (const char* heading : {"\nScene:\n", "\nView and device:\n", "\nMap:\n", "\nBias and filter:\n",
                              "\nMeasurement and output:\n", "\nExit codes: 0 success;"}) {
    const size_t found = help.find(heading, at);
    EXPECT_NE(found, std::string::npos) << heading;
    at = std::min(found, help.size());
  }
  for (const char* verb : {"render", "fog", "vsv", "bench", "info", "scene", "report", "reproduce"})
    EXPECT_TRUE(has(run(fmt::format("{} --help", verb)).out, "130 interrupted")) << verb;
  EXPECT_TRUE(has(help, "comma-separated, or all:"));
  EXPECT_FALSE(has(run("render --help").out, "comma-separated, or all:"));  // of which it draws one
}

TEST_F(UsageTest, TheVersionSaysWhatItWasBuiltFrom) {
  const std::string version = run("--version").out;
  EXPECT_TRUE(version.starts_with("gnomon 0.")) << version;
  for (const char* what : {"built by ", "Vulkan headers 1.", "embree 3.", "OpenVDB 10", "fmt ", "CLI11 "})
    EXPECT_TRUE(has(version, what)) << what << "\n" << version;
}

TEST_F(UsageTest, AFlagWithoutEffectIsTold) {
  const std::string small = " --size 16 --map-size 16 --quiet ";
  const auto told = [&](const std::string& line) {
    const Result result = run(line + small);
    EXPECT_EQ(result.exitCode, 0) << line << "\n" << result.err;
    return result.err;
  };
  const std::string compare = "compare contact --biases none --repeats 1 ";
  EXPECT_TRUE(has(told(compare + "--constant-offset 0.1"), "--constant-offset has no effect: constant is not among"));
  EXPECT_TRUE(has(told(compare + "--jitter4x4-width 2"), "jitter4x4 is not among --filters"));
  EXPECT_TRUE(has(told(compare + "--epsilon-at stored"), "--epsilon-at has no effect"));
  // Even the default, where it is given.
  EXPECT_TRUE(has(told(compare + "--maps spot --cube-depth hyperbolic"), "the map spot has no such option"));
  EXPECT_TRUE(has(told(compare + "--until-map-size 64"), "it is of --until-error"));
  EXPECT_TRUE(has(told("fog grate --vsv-size 64x64x128 --steps 4 --bound 0.1 -o @/a.exr"), "which --truth makes"));
  EXPECT_TRUE(has(told("fog grate --integrators march --steps 4 --vsv-size 64x64x128 -o @/a.exr"), "no shadow volume"));
  // A variant has its parameter by the name of what it is a variant of.
  EXPECT_FALSE(
      has(told("compare contact --biases adaptive-clamped,constant --maps cube --cube-depth radial --repeats 1 "
               "--constant-offset 0.1 --epsilon-at stored"),
          "no effect"));
}

TEST_F(UsageTest, NoOutputReplacesWhatTheRunReads) {
  ASSERT_EQ(run("scene contact -o @/a.glb").exitCode, 0);
  const std::string scene = readFile(folder_ / "a.glb");
  for (const char* command : {"compare @/a.glb --biases none --quiet --json @/a.glb", "render @/a.glb -o @/./a.glb",
                              "export @/a.glb -o @/a.glb", "fog @/a.glb --quiet --json @/a.glb -o @/f.png"}) {
    const Result result = run(command);
    EXPECT_EQ(result.exitCode, 2) << command;
    EXPECT_TRUE(has(result.err, "this run reads that file")) << result.err;
  }
  EXPECT_EQ(readFile(folder_ / "a.glb"), scene);
  // Words that are no files, though there are folders of that name.
  for (const char* name : {"cube", "contact"}) {
    fs::create_directory(folder_ / name);
    const std::string command = fmt::format(
        "cd '{}' && '{}' compare contact --maps cube --biases none --size 16 --map-size 16 --repeats 1 --quiet "
        "--json {}/results.json >out",
        folder_.string(), test::inBuild("gnomon"), name);
    EXPECT_EQ(std::system(command.c_str()), 0) << name;
  }
  for (const char* file : {"@/out/report.html", "@/out/../out/results.json", "@/out/cube/none.png"}) {
    const Result result = run(std::string("compare contact -o @/out --json ") + file);
    EXPECT_EQ(result.exitCode, 2) << file;
    EXPECT_TRUE(has(result.err, "--out writes there, too")) << result.err;
  }
  EXPECT_EQ(run("compare contact --maps cube --biases none --size 16 --map-size 16 --repeats 1 --quiet -o @/out --json "
                "@/out/numbers/r.json")
                .exitCode,
            1);  // no such folder, and no conflict
  for (const char* file : {"@/out/report.html", "@/out/results.json", "@/out/pictures/runs.exr"}) {
    const Result result = run(std::string("fog grate -o @/out --json ") + file);
    EXPECT_EQ(result.exitCode, 2) << file;
    EXPECT_TRUE(has(result.err, "--out writes there, too")) << result.err;
  }
  EXPECT_TRUE(has(run("fog grate -o @/b.png --json @/b.png").err, "--json writes there, too") ||
              has(run("fog grate -o @/b.png --json @/b.png").err, "--out writes there, too"));
}

TEST_F(UsageTest, AnOrbitAboutAnAxisThroughTheLightIsTold) {
  const std::string fog =
      "fog contact --frames 2 --vsv-size 64x64x128 --steps 4 --size 16 --map-size 16 --quiet --move ";
  const Result info = run("info contact");
  float x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0;
  const size_t at = info.out.find("bounds ");
  ASSERT_EQ(std::sscanf(info.out.c_str() + at, "bounds %f,%f,%f to %f,%f,%f", &x0, &y0, &z0, &x1, &y1, &z1), 6);
  const std::string above = fmt::format(" --light {},{},{} ", 0.5 * (x0 + x1), 0.9 * y1, 0.5 * (z0 + z1));
  EXPECT_TRUE(has(run(fog + "orbit:y,90 -o @/a" + above).err, "is on the axis, and does not move"));
  EXPECT_FALSE(has(run(fog + "orbit:x,9 -o @/b" + above).err, "on the axis"));
  // An axis of any length.
  EXPECT_TRUE(has(run(fog + "orbit:0,1e-200,0,90 -o @/c" + above).err, "is on the axis, and does not move"));
}

TEST_F(UsageTest, TheDefaultMapIsTheLights) {
  const auto mapOf = [&](const std::string& flags) {
    return compared("contact --biases none " + flags).at("rows").at(0).at("map").get<std::string>();
  };
  EXPECT_EQ(mapOf("--light lamp"), "cube");
  EXPECT_EQ(mapOf("--light spot"), "spot");
  EXPECT_EQ(mapOf("--light sun"), "directional");
  EXPECT_EQ(mapOf("--light lamp --cone 60"), "spot");
  EXPECT_EQ(mapOf("--light lamp --warp psm"), "spot");
}

TEST_F(UsageTest, ASpotMayShineIntoHalfOfAllDirections) {
  const json results = compared("contact --light spot --cone 180 --maps spot --biases none");
  EXPECT_NEAR(results.at("light").at("cone_degrees").get<double>(), 180.0, 1e-3);
  EXPECT_TRUE(has(results.at("truth").at("fit_note"), "a cone of 180 degrees on one plane"));
  EXPECT_EQ(results.at("rows").at(0).at("uncovered"), 0);
}

TEST_F(UsageTest, WhatCastsNoShadowIsSeenAllTheSame) {
  const auto truth = [&](const std::string& flags) {
    return compared("contact --light lamp --biases none,adaptive,witness,dual " + flags).at("truth");
  };
  const json all = truth(""), none = truth("--casters floor"), without = truth("--exclude cube --exclude 'tall box'");
  EXPECT_EQ(none.at("scored"), all.at("scored"));
  EXPECT_EQ(none.at("lit"), none.at("scored"));  // a floor shadows nothing
  EXPECT_EQ(without.at("scored"), all.at("scored"));
  EXPECT_GT(without.at("lit"), all.at("lit"));
  // No bias is needed where nothing but the floor casts, and nobody shadows himself.
  const json rows = compared("contact --light lamp --biases none --exclude floor").at("rows");
  const json usual = compared("contact --light lamp --biases none").at("rows");
  EXPECT_LT(rows.at(0).at("acne").get<int>(), usual.at(0).at("acne").get<int>() / 3);
  // The same in fog, whose reference must not be taken for another's.
  const auto fog = [&](const std::string& flags) {
    const Result result =
        run("fog grate --truth --size 24 --vsv-size 64x64x128 --map-size 64 --steps 8 --repeats 1 "
            "--bound 0.05 --json @/f.json " +
            flags);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return json::parse(readFile(folder_ / "f.json")).at("reference").at("mean").get<double>();
  };
  std::string bars;
  const std::string info = run("info grate").out;
  for (size_t at = info.find("mesh '"); at != std::string::npos; at = info.find("mesh '", at + 1)) {
    const std::string name = info.substr(at + 6, info.find('\'', at + 6) - at - 6);
    bars += " --exclude '" + name + "'";
    if (std::count(bars.begin(), bars.end(), '-') >= 2) break;
  }
  EXPECT_NE(fog(""), fog(bars));
}

TEST_F(UsageTest, ClosedMeshesCountAsSolidsWhereOneSaysSo) {
  // A box that its file calls doubleSided, as many exporters do.
  writeTextFile(folder_ / "make.py", R"(
import json, struct, sys
v = [(x, y, z) for x in (-1, 1) for y in (0, 2) for z in (-1, 1)]
v += [(-9, 0, -9), (-9, 0, 9), (9, 0, 9), (9, 0, -9)]
box = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3]
ground = [8, 9, 10, 8, 10, 11]
data = b''.join(struct.pack('<3f', *p) for p in v) + struct.pack('<42H', *box, *ground)
open(sys.argv[1] + '.bin', 'wb').write(data)
def view(o, n): return {'buffer': 0, 'byteOffset': o, 'byteLength': n}
def indices(view, n): return {'bufferView': view, 'componentType': 5123, 'count': n, 'type': 'SCALAR'}
def mesh(name, i): return {'name': name, 'primitives': [{'attributes': {'POSITION': 0}, 'indices': i, 'material': 0}]}
json.dump({
  'asset': {'version': '2.0'}, 'scene': 0,
  'scenes': [{'name': 'whole', 'nodes': [0, 2]}, {'name': 'floor', 'nodes': [2]}],
  'nodes': [{'name': 'rig', 'children': [1]}, {'name': 'box', 'mesh': 0}, {'name': 'ground', 'mesh': 1}],
  'materials': [{'doubleSided': True}], 'meshes': [mesh('crate', 1), mesh('plane', 2)],
  'buffers': [{'byteLength': len(data), 'uri': sys.argv[1].split('/')[-1] + '.bin'}],
  'bufferViews': [view(0, 144), view(144, 72), view(216, 12)],
  'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 12, 'type': 'VEC3'}, indices(1, 36), indices(2, 6)],
}, open(sys.argv[1], 'w'))
)");
  const std::string scene = (folder_ / "box.gltf").string();
  ASSERT_EQ(std::system(("python3 '" + (folder_ / "make.py").string() + "' '" + scene + "'").c_str()), 0);
  EXPECT_TRUE(has(run("info " + scene).out, "mesh 'crate': 12 triangles, sheet (closed, but doubleSided)"));
  EXPECT_TRUE(has(run("info " + scene + " --solids closed").out, "mesh 'crate': 12 triangles, solid"));
  EXPECT_TRUE(has(run("info " + scene + " --solids auto").out, "mesh 'crate': 12 triangles, solid"));
  const std::string flags = " --light 3,5,2 --camera eye:6,5,6,target:0,0,0 --biases none,second-depth ";
  const json sheets = compared(scene + flags), solids = compared(scene + flags + "--solids closed");
  EXPECT_TRUE(has(sheets.at("notes").dump(), "second-depth: made for solids, and the scene has none"));
  EXPECT_FALSE(has(solids.at("notes").dump(), "made for solids"));
  const auto acne = [](const json& results, size_t row) { return results.at("rows").at(row).at("acne").get<int>(); };
  EXPECT_LT(acne(solids, 1), acne(sheets, 1));  // the box's lit sides are in front of what the map holds
  // A part of the file, and a part of a path.
  EXPECT_TRUE(has(run("info " + scene + " --scene-index 1").out, ": 2 triangles,"));
  EXPECT_EQ(run("info " + scene + " --scene-index 0").out, run("info " + scene).out);
  expectMistake("info " + scene + " --scene-index 2", 2, "has scenes 0 (whole), 1 (floor)");
  for (const char* name : {"box", "crate", "rig", "rig/box"}) {
    const json without = compared(scene + flags + fmt::format("--exclude {}", name));
    EXPECT_EQ(without.at("truth").at("lit"), without.at("truth").at("scored")) << name;
    EXPECT_LT(sheets.at("truth").at("lit"), sheets.at("truth").at("scored"));
    EXPECT_TRUE(has(without.at("rows").at(0).at("command"), fmt::format("--exclude {}", name)));
  }
  expectMistake("compare " + scene + " --exclude rig --exclude ground", 2, "leave nothing to cast a shadow");
}

TEST_F(UsageTest, OneExposureForSeveralPictures) {
  const auto mean = [&](const std::string& command) {
    const Result result = run(command + " -o @/a.exr");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    const ImageF image = readImage(folder_ / "a.exr");
    double sum = 0.0;
    for (int i = 0; i < image.width * image.height; ++i)
      sum += static_cast<double>(image.values[static_cast<size_t>(i * image.channels)]);
    told_ = result.out;
    return sum / image.width / image.height;
  };
  const std::string render = "render contact --light lamp --size 32 --map-size 64 ";
  const double usual = mean(render);
  const size_t at = told_.find("exposed by ");
  ASSERT_NE(at, std::string::npos) << told_;
  const double factor = std::stod(told_.substr(at + 11));
  EXPECT_NEAR(mean(render + fmt::format("--exposure {}", factor)), usual, 1e-4 * usual);
  // A lamp of twice the power is as bright as ever by itself, and brighter with the same exposure.
  EXPECT_NEAR(mean(render + "--intensity 64"), usual, 1e-4 * usual);
  EXPECT_GT(mean(render + fmt::format("--intensity 64 --exposure {}", factor)), 1.3 * usual);
  const auto fogPixels = [&](const std::string& flags) {
    EXPECT_EQ(run("fog grate --size 24 --vsv-size 64x64x128 --integrators runs " + flags + " -o @/f.png").exitCode, 0);
    return readFile(folder_ / "f.png");
  };
  EXPECT_EQ(fogPixels("--intensity 100 --exposure 0.01"), fogPixels("--intensity 200 --exposure 0.005"));
  EXPECT_NE(fogPixels("--intensity 100 --exposure 0.01"), fogPixels("--intensity 200 --exposure 0.01"));
}

TEST_F(UsageTest, AnExrSaysWhatItIsAndWhereItCameFrom) {
  ASSERT_EQ(run("render contact --show depth --size 16 --map-size 16 -o @/depth.exr").exitCode, 0);
  ASSERT_EQ(run("fog grate --size 16 --vsv-size 64x64x128 -o @/fog.exr").exitCode, 0);
  const std::string depth = readFile(folder_ / "depth.exr"), fog = readFile(folder_ / "fog.exr");
  for (const char* what :
       {"gnomon:command", "gnomon render contact --show depth", "gnomon:units", "metres", "gnomon 0."})
    EXPECT_TRUE(has(depth, what)) << what;
  for (const char* what : {"cd/m^2", "chromaticities", "linear, primaries of ITU-R BT.709"})
    EXPECT_TRUE(has(fog, what)) << what;
  EXPECT_TRUE(has(depth, "none: data"));
  EXPECT_FALSE(has(depth, "chromaticities"));
}

TEST_F(UsageTest, NotesTellWhatAReaderShouldKnow) {
  const json results = compared("contact --light all --maps cube --biases none");
  EXPECT_TRUE(has(results.at("notes").dump(), "light 'sun' is left out: a cube map is not made for its kind"));
  // A map so fine that the exact shadow's margin blurs what it holds.
  const Result result =
      run("compare contact --light lamp --maps spot --cone 1 --direction 2.6,-3.4,0.4 --biases none --map-size 4096 "
          "--size 64 --repeats 1 --json @/fine.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json fine = json::parse(readFile(folder_ / "fine.json"));
  ASSERT_FALSE(fine.at("notes").empty());
  EXPECT_TRUE(has(fine.at("notes").dump(), "the exact shadow's margin")) << fine.at("notes");
  EXPECT_GT(fine.at("truth").at("margin").get<double>(), fine.at("truth").at("texel").get<double>() / 256.0);
  EXPECT_TRUE(compared("contact --light lamp --biases none").at("notes").empty());
}

TEST_F(UsageTest, AValueTunedToTheEndOfItsRangeIsMarked) {
  const Result result = run(
      "compare tilted-planes --maps spot --biases cosine,adaptive --tune --size 64 --map-size 32 --repeats 1 -o @/out");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_TRUE(has(result.out, "m (the upper end of what was tried) after")) << result.out;
  const json rows = json::parse(readFile(folder_ / "out" / "results.json")).at("rows");
  for (const json& row : rows)
    if (row.at("tuned").get<bool>()) {
      EXPECT_EQ(row.at("tuning").at("at_end"), row.at("bias") == "cosine" ? "upper" : "") << row;
    }
  EXPECT_TRUE(has(readFile(folder_ / "out" / "report.html"), "It is the upper end of those values"));
}

TEST_F(UsageTest, ThePageRanksSumsAndPutsTheLightsBelow) {
  const Result result = run(
      "compare contact --light all --maps cube --biases none,adaptive,constant --size 48 --map-size 32 --repeats 1 -o "
      "@/out");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const std::string page = readFile(folder_ / "out" / "report.html");
  std::string ranks, marks;
  for (size_t at = page.find("<span class=\"rank\">"); at != std::string::npos;
       at = page.find("<span class=\"rank\">", at + 1))
    ranks += page.substr(at + 19, page.find('<', at + 19) - at - 19) + " ";
  EXPECT_EQ(ranks, "1 1.1 1.2 2 2.1 2.2 3 3.1 3.2 ");
  size_t drawn = 0;
  for (size_t at = page.find("class=\"mark"); at != std::string::npos; at = page.find("class=\"mark", at + 1)) ++drawn;
  EXPECT_EQ(drawn, 6u + 1u);  // a mark a sum, in two sizes, and the shapes' definitions
  EXPECT_TRUE(has(page, "blue is too light and orange too dark"));
  EXPECT_TRUE(has(page, "light &apos;sun&apos; is left out") || has(page, "light 'sun' is left out") ||
              has(page, "light &#39;sun&#39; is left out"));
}

TEST_F(UsageTest, BenchIsAsSmallAsItIsAskedToBe) {
  const Result result =
      run("bench contact --map-size 16 --size 32 --vsv-size 64x64x128 --repeats 1 --only gbuffer --no-start "
          "--most-triangles 10000 --json @/b.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json bench = json::parse(readFile(folder_ / "b.json"));
  for (const json& growth : bench.at("growth")) {
    const double most = growth.at("points").back().at("size").get<double>();
    const std::string size = growth.at("size");
    EXPECT_TRUE(size != "map texels" || most == 6 * 64 * 64) << most;
    EXPECT_TRUE(size != "pixels" || most == 128 * 128) << most;
  }
  expectMistake("bench contact --map-size 16 --map-texels 4096", 2, "excludes");
}

TEST_F(UsageTest, DensitiesThatFollowOneAnotherAreFrames) {
  for (const auto& [number, density] : {std::pair{3, "puff"}, {4, "fog"}, {5, "puff"}})
    ASSERT_EQ(run(fmt::format("scene --density {} -o @/puff.{:03}.vdb", density, number)).exitCode, 0);
  const std::string fog =
      "fog grate --density @/puff.###.vdb --integrators march --steps 8 --size 24 --map-size 32 "
      "--repeats 1 --quiet -o @/out ";
  const Result result = run(fog + "--frames 3");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const json frames = json::parse(readFile(folder_ / "out" / "results.json")).at("frames");
  EXPECT_EQ(frames.at("moves"), "density");
  EXPECT_EQ(frames.at("count"), 3);
  std::string last;
  for (const auto& entry : fs::directory_iterator(folder_ / "out" / "frames")) {
    if (!entry.is_directory()) continue;
    const std::string first = readFile(entry.path() / "0000.png");
    EXPECT_FALSE(first == readFile(entry.path() / "0001.png"));
    EXPECT_TRUE(first == readFile(entry.path() / "0002.png"));
    last = entry.path().filename().string();
  }
  EXPECT_FALSE(last.empty());
  ASSERT_EQ(run(fog + "--frames 2 --move light:0.2,0,0 --first-frame 4").exitCode, 0);
  EXPECT_EQ(json::parse(readFile(folder_ / "out" / "results.json")).at("frames").at("moves"), "light and density");
  expectMistake(fog + "--frames 4", 1, "puff.006.vdb: does not exist");
}

TEST_F(UsageTest, HelpEndsOnceWithExitCodesAndAWrongFirstFlagIsNamed) {
  for (const char* verb : {"compare", "fog", "info", "man"}) {
    const std::string help = run(std::string(verb) + " --help").out;
    const size_t first = help.find("Exit codes:");
    ASSERT_NE(first, std::string::npos) << verb;
    EXPECT_EQ(help.find("Exit codes:", first + 1), std::string::npos) << verb;
    EXPECT_TRUE(has(help, "GNOMON_DEVICE")) << verb;
  }
  const auto misspelt = run("--verison");
  EXPECT_EQ(misspelt.exitCode, 2);
  EXPECT_TRUE(has(misspelt.err, "--verison: no such flag; did you mean --version? (see gnomon --help)"));
}

TEST_F(UsageTest, ATerminalIsToldHowLongTheRestTakes) {
  if (!isInstalled("script")) GTEST_SKIP() << "skipped: no script here";
  // Ten seconds of work on a fast machine, ended as soon as it tells, or after two minutes.
  const std::string command =
      test::inBuild("gnomon") + " compare contact --maps cube --biases none --size 768 --map-size 1024 --repeats 1000";
  const std::string typed = (folder_ / "typed").string();
  const std::string whole = fmt::format(
      "script -qfc '{0}' '{1}' >/dev/null 2>&1 & typist=$!; "
      "for i in $(seq 600); do grep -q ' left' '{1}' 2>/dev/null && break; sleep 0.2; done; "
      "kill $typist; wait $typist; grep -q ' left' '{1}'",
      command, typed);
  EXPECT_EQ(std::system(whole.c_str()), 0) << readFile(typed);
  EXPECT_FALSE(has(run("compare contact --maps cube --biases none --size 32 --map-size 32 --repeats 50").err, "left"));
}

}  // namespace
}  // namespace gnomon
