// Ctrl-C during long work: what is done is there, whole and readable, and the exit code says what happened.
#include "cli_fixture.h"
#include "running_program.h"

#include <chrono>
#include <iterator>
#include <sstream>

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using test::CliTest;
using test::RunningProgram;

// A file of this name somewhere below, aside or in its place.
bool isBelow(const fs::path& folder, const std::string& name) {
  std::error_code failure;
  for (fs::recursive_directory_iterator it(folder, failure), end; !failure && it != end; it.increment(failure))
    if (it->path().generic_string().ends_with(name)) return true;
  return false;
}

std::vector<std::string> longCompare(std::vector<std::string> more) {
  std::vector<std::string> words = {"compare",       "contact", "--maps", "spot,cube",  "--biases",
                                    "none,adaptive", "--size",  "96",     "--map-size", "64",
                                    "--repeats",     "1000",    "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_F(CliTest, AnInterruptedCompareLeavesTheRowsThatAreDone) {
  RunningProgram program(longCompare({"-o", "out", "--json", "r.json"}), folder_);
  ASSERT_TRUE(program.waitUntil([&] { return isBelow(folder_ / "out", "spot/adaptive.exr"); }));
  EXPECT_EQ(program.end(SIGINT), 130);
  EXPECT_NE(readFile(folder_ / "stderr").find("interrupted"), std::string::npos);
  const auto results = nlohmann::json::parse(readFile(folder_ / "out" / "results.json"));
  EXPECT_FALSE(results.at("complete"));
  EXPECT_GE(results.at("rows").size(), 2u);
  for (const auto& row : results.at("rows")) {
    EXPECT_GT(row.at("scored"), 0);
    EXPECT_GT(row.at("shade_ms"), 0.0);
    EXPECT_TRUE(fs::exists(folder_ / "out" / row.at("pictures").at("labels").get<std::string>()));
  }
  EXPECT_EQ(nlohmann::json::parse(readFile(folder_ / "r.json")), results);
  ASSERT_EQ(run("report @/out -o @/page.html").exitCode, 0);
  EXPECT_NE(readFile(folder_ / "page.html").find("This run was interrupted"), std::string::npos);
  for (const auto& entry : fs::directory_iterator(folder_ / "out"))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".gnomon")) << entry.path();
}

TEST_F(CliTest, AKilledCompareHasWrittenTheMapsBefore) {
  RunningProgram program({"compare", "contact", "--maps", "spot,cube", "--biases", "none", "--size", "64", "--map-size",
                          "64", "--repeats", "400", "--quiet", "--json", "r.json"},
                         folder_);
  ASSERT_TRUE(program.waitUntil([&] { return fs::exists(folder_ / "r.json"); }));
  EXPECT_EQ(program.end(SIGKILL), -SIGKILL);
  const auto results = nlohmann::json::parse(readFile(folder_ / "r.json"));
  if (results.at("rows").size() == 2) GTEST_SKIP() << "skipped: it was done before it could be killed";
  EXPECT_FALSE(results.at("complete"));
  ASSERT_EQ(results.at("rows").size(), 1u);
  EXPECT_EQ(results.at("rows").at(0).at("map"), "spot");
}

TEST_F(CliTest, InterruptedBeforeAnythingIsDoneNothingIsWritten) {
  RunningProgram program({"compare", "atrium", "--size", "1024", "--map-size", "2048", "--tune", "--filters", "all",
                          "--json", "r.json", "--quiet", "-o", "out"},
                         folder_);
  // The folder is made first; the work itself takes many seconds.
  ASSERT_TRUE(program.waitUntil([&] { return fs::exists(folder_ / "out"); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const int code = program.end(SIGINT);
  EXPECT_TRUE(code == 130 || code == -SIGINT) << code;
  if (code == -SIGINT) return;  // the guard was not yet there
  if (!fs::exists(folder_ / "r.json")) return;
  EXPECT_FALSE(nlohmann::json::parse(readFile(folder_ / "r.json")).at("complete"));
}

TEST_F(CliTest, InterruptedFramesAreWholeAndCounted) {
  RunningProgram program({"fog", "grate", "--size", "48", "--vsv-size", "64x64x128", "--integrators", "runs",
                          "--frames", "500", "--move", "orbit:y,360", "--quiet", "-o", "out"},
                         folder_);
  ASSERT_TRUE(program.waitUntil([&] { return isBelow(folder_ / "out", "frames/runs/0003.png"); }));
  EXPECT_EQ(program.end(SIGINT), 130);
  const auto frames = nlohmann::json::parse(readFile(folder_ / "out" / "results.json")).at("frames");
  size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "out" / "frames" / "runs"))
    count += readFile(entry.path()).ends_with("IEND\xae\x42\x60\x82") ? 1 : 0;
  EXPECT_GE(count, 4u);
  EXPECT_LT(count, 500u);
  EXPECT_EQ(frames.at("count"), count);
  EXPECT_EQ(frames.at("degrees"), 360.0);
  const std::string page = readFile(folder_ / "out" / "report.html");
  EXPECT_NE(page.find("Frame 0 of runs"), std::string::npos);
  EXPECT_NE(page.find("the light goes 360° round the axis 0, 1, 0"), std::string::npos);
}

TEST_F(CliTest, AnInterruptedReferenceLeavesThePicturesWithoutIt) {
  const std::string pictures =
      "fog grate --size 256 --vsv-size 64x64x128 --map-size 64 --repeats 1 --steps 8 --no-cache --quiet -o ";
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run(pictures + "@/without").exitCode, 0);
  const auto taken = std::chrono::steady_clock::now() - begin;
  std::istringstream words(pictures + "out --truth --bound 1e-6");
  RunningProgram program({std::istream_iterator<std::string>(words), {}}, folder_);
  ASSERT_TRUE(program.waitUntil([&] { return fs::exists(folder_ / "out"); }));
  std::this_thread::sleep_for(2 * taken);  // the pictures are there; the reference takes minutes
  EXPECT_EQ(program.end(SIGINT), 130);
  const auto results = nlohmann::json::parse(readFile(folder_ / "out" / "results.json"));
  EXPECT_FALSE(results.at("complete"));
  EXPECT_TRUE(results.at("reference").is_null());
  EXPECT_TRUE(isBelow(folder_ / "out", ".beauty.png"));
}

TEST_F(CliTest, AnInterruptedVolumeOrPaperLeavesNothing) {
  const std::vector<std::vector<std::string>> commands = {
      {"vsv", "atrium", "--vsv-size", "1024x1024x1024", "--validate", "-o", "out", "--quiet"},
      {"reproduce", "dou2014", "-o", "out", "--quiet"}};
  for (const std::vector<std::string>& words : commands) {
    RunningProgram program(words, folder_);
    ASSERT_TRUE(program.waitUntil([&] { return fs::exists(folder_ / "out") && !fs::is_empty(folder_ / "out"); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // both take seconds
    EXPECT_EQ(program.end(SIGINT), 130) << words.front();
    EXPECT_NE(readFile(folder_ / "stderr").find("interrupted"), std::string::npos);
    EXPECT_TRUE(!fs::exists(folder_ / "out") || fs::is_empty(folder_ / "out")) << words.front();
  }
}

}  // namespace
}  // namespace gnomon
