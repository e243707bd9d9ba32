// The program's answers to mistakes: the right exit code, one clear line, nothing written.
#include "cli_fixture.h"

#include <fcntl.h>
#include <sys/file.h>

#include <fmt/format.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using test::CliTest;
using test::Result;

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

TEST_F(CliTest, ReproduceRefusesWhatItCannotRunInOneLine) {
  expectMistake("reproduce", 2, "PAPER");
  expectMistake("reproduce williams1978", 2, "no such paper; choose from weiskopf2003, dou2014");
  expectMistake("reproduce dou2014 --scale 7", 2, "--scale 7 is outside 0.05..1");
  expectMistake("reproduce dou2014 --repeats 0", 2, "--repeats");
  expectMistake("reproduce weiskopf2003 --scene @/nowhere.glb -o @/out", 1, "nowhere.glb");
  EXPECT_EQ(fileCount(), 0u);
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

TEST_F(CliTest, AThresholdThatIsCrossedExitsWith3) {
  const std::string base =
      "compare tilted-planes --maps spot --biases none,adaptive --size 64 --map-size 64 --repeats 1 ";
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
  expectMistake("compare contact --fail-if 'adaptiv:acne>0.1%'", 2, "did you mean adaptive?");
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

TEST_F(CliTest, WhatIsMisspeltIsAnsweredWithWhatWasMeant) {
  expectMistake("compar contact", 2, "compar: no such subcommand; did you mean compare? Choose from compare, render,");
  expectMistake("shadows contact", 2, "shadows: no such subcommand; choose from compare, render,");
  expectMistake("compare contact --bises none", 2, "--bises: compare has no such flag; did you mean --biases?");
  expectMistake("compare contact --constant-ofset=1", 2, "did you mean --constant-offset?");
  expectMistake("fog grate --sigma_s 1", 2, "did you mean --sigma-s?");
  expectMistake("compare contact other.glb", 2, "other.glb: one word too many");
  expectMistake("compare contact --biases adpative", 2, "did you mean adaptive? Choose from none, constant,");
  expectMistake("compare contact --maps cubes", 2, "did you mean cube?");
  expectMistake("compare contact --maps para", 2, "did you mean paraboloid?");
  expectMistake("compare contact --filters biliner", 2, "did you mean bilinear?");
  expectMistake("compare contact --cube-depth Radial", 2, "did you mean radial?");
  expectMistake("compare contact --epsilon-at store", 2, "did you mean stored?");
  expectMistake("render contact --show label -o @/a.png", 2, "did you mean labels?");
  expectMistake("fog grate --integrators runz", 2, "did you mean runs?");
  expectMistake("reproduce dou2041", 2, "did you mean dou2014?");
  expectMistake("compare atriom", 1, "did you mean atrium?");
  expectMistake("compare atrium --light lantren --size 16", 2, "did you mean lantern?");
  EXPECT_EQ(fileCount(), 0u);
}

TEST_F(CliTest, TheWorldsFailuresExitWith1AndOneLine) {
  expectMistake("compare nowhere.glb", 1, "nowhere.glb");
  expectMistake("compare contact --light moon --size 16", 2, "--light moon: the scene has no light of this name");
  expectMistake("compare contact --camera x --size 16", 2, "--camera x: the scene has no camera of this name");
  expectMistake("compare contact --device Voodoo2 --size 16", 1, "Voodoo2");
  expectMistake("compare contact --camera eye:0,1000,0,target:0,2000,0 --size 16", 1, "the camera sees no surface");
  expectMistake("render contact --size 16 --map-size 16 -o /proc/nowhere/a.png", 1, "/proc/nowhere");
  expectMistake("fog grate --density @/none.vdb --size 16", 1, "none.vdb");
  expectMistake("fog atrium --light moon --size 16", 2, "--light moon");
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

TEST_F(CliTest, WhatIsLostOnTheWayOutExitsWith1) {
  const std::string full = std::string(GNOMON_PROGRAM) + " scene > /dev/full 2>" + (folder_ / "err").string();
  EXPECT_EQ(WEXITSTATUS(std::system(full.c_str())), 1);
  EXPECT_EQ(readFile(folder_ / "err"),
            "gnomon: standard output: cannot be written, part of it is lost; No space left on device\n");
  const std::string closed = std::string(GNOMON_PROGRAM) + " --version >&- 2>" + (folder_ / "err").string();
  EXPECT_EQ(WEXITSTATUS(std::system(closed.c_str())), 1);
  EXPECT_NE(readFile(folder_ / "err").find("standard output"), std::string::npos);
}

TEST_F(CliTest, OutputsThatCannotBeWrittenAreFoundBeforeTheWork) {
  writeTextFile(folder_ / "file", "");
  // The scene is not there either, and would be told if it were looked for first.
  for (const char* line :
       {"render none.glb -o @/file/a.png", "compare none.glb --json @/file/a.json", "compare none.glb -o @/file",
        "fog none.glb -o @/file/a.exr", "fog none.glb -o @/file", "vsv none.glb --vdb @/file/a.vdb",
        "vsv none.glb -o @/file", "bench none.glb --svg @/file/a", "report none -o @/file/a.html",
        "scene none -o @/file/a.glb", "reproduce dou2014 --scene none.glb -o @/file"})
    expectMistake(line, 1, (folder_ / "file").string() + (std::string(line).ends_with("file") ? "" : "/a"));
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(CliTest, ASecondRunInAFolderIsRefusedAndAFailedOneLeavesNoFolder) {
  fs::create_directory(folder_ / "out");
  const Descriptor held(::open((folder_ / "out").c_str(), O_RDONLY));
  ASSERT_EQ(::flock(held.get(), LOCK_EX), 0);
  expectMistake("compare contact --size 16 -o @/out", 1, "out: another gnomon is writing there");
  expectMistake("compare none.glb -o @/new", 1, "none.glb");
  EXPECT_EQ(fileCount(), 1u);
}

#if !defined(GNOMON_SANITIZED)  // sanitizers take terabytes of addresses
TEST_F(CliTest, ALimitOnMemoryIsOneLineAboutMemory) {
  for (const int mebibytes : {250, 400, 600, 700, 800}) {
    const std::string line = fmt::format(
        "ulimit -v {}; {} compare contact --maps spot --biases none --size 64 --map-size 64 --repeats 1 -o {} "
        ">/dev/null 2>{}",
        mebibytes << 10, GNOMON_PROGRAM, (folder_ / "out").string(), (folder_ / "err").string());
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 1) << mebibytes;
    const std::string error = readFile(folder_ / "err");
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
    EXPECT_NE(error.find("memory"), std::string::npos) << error;
    EXPECT_EQ(error.find("install"), std::string::npos) << error;
  }
}
#endif

TEST_F(CliTest, AnEmptyValueIsWrongUsage) {
  for (const char* line :
       {"compare contact --json ''", "compare contact -o ''", "compare contact --light=", "render '' -o @/a.png",
        "fog grate --density '' -o @/a.png", "render contact --shader-dir '' -o @/a.png"})
    expectMistake(line, 2, "empty");
  EXPECT_EQ(fileCount(), 0u);
}

TEST_F(CliTest, PathsThatAreNoUtf8Work) {
  const std::string odd = (folder_ / "odd\xff\xc3(name").string();
  EXPECT_EQ(run("scene corner -o '" + odd + ".glb'").exitCode, 0);
  const Result compared = run("compare '" + odd + ".glb' --biases none --size 24 --map-size 24 --repeats 1 -o '" + odd +
                              "' --json @/a.json");
  EXPECT_EQ(compared.exitCode, 0) << compared.err;
  EXPECT_NE(readFile(folder_ / "a.json").find("odd"), std::string::npos);
  EXPECT_EQ(run("report '" + odd + "' -o '" + odd + ".html'").exitCode, 0);
  expectMistake("info '" + odd + "none.glb'", 1, "odd\\xff\\xc3(name");
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

}  // namespace
}  // namespace gnomon
