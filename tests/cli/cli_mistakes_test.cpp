// The program's answers to mistakes: the right exit code, one clear line, nothing written.
#include "cli_fixture.h"
#include "mistakes.h"

#include "base/sanitizers.h"
#include "tests/base/places.h"

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
  expectMistake("report @/run", 2, "give -o FILE.html");
  expectMistake("report @/nowhere -o @/a.html", 1, "nowhere: does not exist");
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

// In parts, each a line of ctest's, which run side by side.
class MistakesTest : public CliTest, public ::testing::WithParamInterface<int> {
 public:
  static constexpr int kParts = 4;
};

TEST_P(MistakesTest, AreOneLineEachAndLeaveNothing) {
  for (size_t i = static_cast<size_t>(GetParam()); i < std::size(test::kMistakes); i += kParts)
    expectMistake(test::kMistakes[i].words, test::kMistakes[i].exitCode, test::kMistakes[i].told);
  EXPECT_EQ(fileCount(), 0u);
}

INSTANTIATE_TEST_SUITE_P(All, MistakesTest, ::testing::Range(0, MistakesTest::kParts));

TEST_F(CliTest, WhatIsLostOnTheWayOutExitsWith1) {
  const std::string full = test::inBuild("gnomon") + " scene > /dev/full 2>" + (folder_ / "err").string();
  EXPECT_EQ(WEXITSTATUS(std::system(full.c_str())), 1);
  EXPECT_EQ(readFile(folder_ / "err"),
            "gnomon: standard output: cannot be written, part of it is lost; No space left on device\n");
  const std::string closed = test::inBuild("gnomon") + " --version >&- 2>" + (folder_ / "err").string();
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

TEST_F(CliTest, ALimitOnMemoryIsOneLineAboutMemory) {
  if (kHasSanitizers) GTEST_SKIP() << "skipped: sanitizers take terabytes of addresses";
  for (const int mebibytes : {150, 250, 400, 600, 700, 800}) {
    const std::string line = fmt::format(
        "ulimit -v {}; {} compare contact --maps spot --biases none --size 64 --map-size 64 --repeats 1 -o {} "
        ">/dev/null 2>{}",
        mebibytes << 10, test::inBuild("gnomon"), (folder_ / "out").string(), (folder_ / "err").string());
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 1) << mebibytes;
    const std::string error = readFile(folder_ / "err");
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
    EXPECT_NE(error.find("memory"), std::string::npos) << error;
    EXPECT_EQ(error.find("install"), std::string::npos) << error;
  }
}

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

}  // namespace
}  // namespace gnomon
