// gnomon sweep as a person runs it: killed, twice at once, with mistakes, on full disks.
#include "cli_fixture.h"
#include "running_program.h"

#include "lab/store/store.h"
#include "tests/base/places.h"
#include "tests/base/started_process.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <thread>

#include <fmt/format.h>

namespace gnomon {
namespace {

using test::CliTest;

class SweepCliTest : public CliTest {
 protected:
  void SetUp() override {
    writeTextFile(folder_ / "p.json", R"({
  // small
  "scenes": ["contact", "corner"], "size": "64", "repeats": 1, "cameras": ["default", {"random": 1}],
  "maps": ["cube", "directional"], "map_sizes": [48, 64], "biases": ["none", "slope", "witness"]})");
  }

  std::string contents(const std::string& db) const {
    const Store store(folder_ / db, sql::Open::Existing);
    std::string text;
    sql::Statement rows = store.database().prepare(
        "SELECT key, scene, camera, map, map_size, method, scored, agree, acne, leak, rmse, worst_acne FROM results "
        "ORDER BY key");
    while (rows.step()) {
      for (int i = 0; i < rows.columnCount(); ++i) text += rows.text(i) + "|";
      text += "\n";
    }
    return text;
  }

  // The program, started and not waited for.
  pid_t start(const std::string& db) const {
    const Descriptor none = test::openToWrite("/dev/null"), error = test::openToWrite(folder_ / (db + ".err"));
    return test::startProcess(
        {test::inBuild("gnomon"), "sweep", (folder_ / "p.json").string(), "--db", (folder_ / db).string(), "--quiet"},
        {.out = none.get(), .error = error.get()});
  }
};

TEST_F(SweepCliTest, KilledAndResumedItIsAsIfNothingHadHappened) {
  ASSERT_EQ(run("sweep @/p.json --db @/whole.db").exitCode, 0);
  int kills = 0;
  for (int delay = 250; kills < 4 && delay < 4000; delay += 180) {
    const pid_t child = start("killed.db");
    std::this_thread::sleep_for(std::chrono::milliseconds(delay));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (!WIFSIGNALED(status)) break;
    ++kills;
  }
  EXPECT_GT(kills, 0);
  const test::Result last = run("sweep @/p.json --db @/killed.db");
  ASSERT_EQ(last.exitCode, 0) << last.err;
  EXPECT_EQ(contents("killed.db"), contents("whole.db"));
  EXPECT_NE(run("sweep @/p.json --db @/killed.db").out.find("; 0 rows of 0 cases measured"), std::string::npos);
}

TEST_F(SweepCliTest, TwoProcessesOnOneStoreNeverDoACaseTwice) {
  const pid_t a = start("both.db"), b = start("both.db");
  int status = 0;
  for (const pid_t child : {a, b}) {
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << readFile(folder_ / "both.db.err");
  }
  ASSERT_EQ(run("sweep @/p.json --db @/whole.db").exitCode, 0);
  EXPECT_EQ(contents("both.db"), contents("whole.db"));
  // A row that were written twice would have a later rowid than there are rows.
  const Store store(folder_ / "both.db", sql::Open::Existing);
  EXPECT_EQ(store.database().integerOf("SELECT max(rowid) FROM result"),
            store.database().integerOf("SELECT count(*) FROM result"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "both.db-workers"));
}

TEST_F(SweepCliTest, ShardsMergeAndReportsAreWritten) {
  for (const char* shard : {"1/2", "2/2"})
    ASSERT_EQ(run(std::string("sweep @/p.json --shard ") + shard + " --db @/part" + shard[0] + ".db").exitCode, 0);
  const test::Result merged = run("sweep merge @/part1.db @/part2.db -o @/all.db");
  ASSERT_EQ(merged.exitCode, 0) << merged.err;
  expectMistake("sweep merge @/part1.db -o @/all.db", 1, "all.db: exists");
  expectMistake("sweep merge @/part1.db -o @/new.db --dry-run", 2, "merge takes stores and -o");
  const test::Result again = run("sweep @/p.json --db @/all.db");
  EXPECT_NE(again.out.find("; 0 rows of 0 cases measured"), std::string::npos) << again.out;
  EXPECT_NE(again.out.find("witness"), std::string::npos);
  const test::Result report =
      run("report @/all.db -o @/page.html --csv @/a.csv --latex @/a.tex --json @/a.json --markdown -");
  ASSERT_EQ(report.exitCode, 0) << report.err;
  EXPECT_NE(report.out.find("<!-- sweep:ranking -->"), std::string::npos);
  EXPECT_NE(readFile(folder_ / "page.html").find("</html>"), std::string::npos);
  EXPECT_NE(run("sweep @/p.json --db @/all.db --dry-run").out.find("cases"), std::string::npos);
}

// Those of docs/sweep.md, up to the quote that ends each.
TEST_F(SweepCliTest, QueriesOfTheDocumentationRun) {
  ASSERT_EQ(run("sweep @/p.json --db @/plan.db --quiet").exitCode, 0);
  const std::string page = readFile(test::inSource("docs/sweep.md"));
  const Store store(folder_ / "plan.db", sql::Open::Existing);
  size_t queries = 0;
  for (size_t at = page.find("SELECT "), end = at; at != std::string::npos; at = page.find("SELECT ", end)) {
    end = page.find_first_of("\"'\n", at);
    const std::string query = page.substr(at, end - at);
    EXPECT_TRUE(store.database().prepare(query).step()) << query;
    ++queries;
  }
  EXPECT_EQ(queries, 3u);
}

TEST_F(SweepCliTest, MistakesAreOneLine) {
  writeTextFile(folder_ / "bad.json", "{\"scenes\": [\"atrium\"],\n \"maps\": [\"cub\"]}");
  expectMistake("sweep @/bad.json", 1, "bad.json:2:11: maps[0]");
  expectMistake("sweep @/none.json", 1, "none.json");
  for (const char* shard : {"3/2", "+1/2", "01/2", "1/02", "1/+2", "' 1/2'", "'1/ 2'", "1/2/", "0/2", "/", "1"})
    expectMistake(fmt::format("sweep @/p.json --shard {}", shard), 2, "as in 2/8");
  expectMistake("sweep @/p.json --quick", 2, "--quick");
  expectMistake("sweep merge @/p.json -o @/all.db", 1, "p.json");
  expectMistake("sweep merge -o @/all.db", 2, "name the stores");
  writeTextFile(folder_ / "text.db", std::string(9000, 'x'));
  expectMistake("sweep @/p.json --db @/text.db", 1, "text.db: is no SQLite file; name a file that gnomon sweep wrote");
  expectMistake("sweep @/p.json --db @/no/folder/s.db", 1, "check the path");
  expectMistake("report @/text.db -o @/x.html", 1, "name a file that gnomon sweep wrote");
  writeTextFile(folder_ / "bad.json", R"({"scenes": ["atrium"], "maps": ["cu\u001b[31m\nbe"]})");
  expectMistake("sweep @/bad.json", 1, R"(cu\x1b[31m\nbe: no such map; choose from)");
}

TEST_F(SweepCliTest, WhatIsNoStoreIsOneLineAndNothingIsMadeBesideIt) {
  std::filesystem::create_directory(folder_ / "folder.db");
  ASSERT_EQ(::mkfifo((folder_ / "pipe.db").c_str(), 0600), 0);
  writeTextFile(folder_ / "empty.db", "");
  writeTextFile(folder_ / "text.db", "no store\n");
  Store(folder_ / "good.db", sql::Open::Create);
  writeTextFile(folder_ / "cut.db", readFile(folder_ / "good.db").substr(0, 6000));
  const size_t files = fileCount();
  const std::pair<const char*, const char*> wrong[] = {
      {"/dev/null", "is a device or a pipe"}, {"@/pipe.db", "is a device or a pipe"},
      {"@/folder.db", "is a folder"},         {"@/empty.db", "is empty"},
      {"@/text.db", "is no SQLite file"},     {"@/cut.db", "database disk image is malformed"},
      {"@/absent.db", "does not exist"}};
  for (const auto& [name, what] : wrong) {
    const std::string store = name;
    const std::string file = store.substr(store.rfind('/') + 1) + ": ";
    expectMistake("sweep merge @/good.db " + store + " -o @/new/all.db", 1, file + what);
    if (store != "@/folder.db") expectMistake("report " + store, 1, file + what);
    if (store != "@/empty.db" && store != "@/absent.db") {  // which it would make
      expectMistake("sweep @/p.json --db " + store, 1, file + what);
      expectMistake("sweep @/p.json --dry-run --db " + store, 1, file + what);
      EXPECT_EQ(run("sweep @/p.json --slurm --db " + store).exitCode, 1) << store;
    }
    if (store != "@/folder.db")
      expectMistake("export --results " + store, 1, store == "@/absent.db" ? "does not exist" : "is no results.json");
    EXPECT_EQ(fileCount(), files) << store;
  }
  expectMistake("sweep @/pipe.db", 1, "pipe.db: is no regular file");
  expectMistake("report @/folder.db -o @/x.html", 1, "folder.db/results.json: does not exist");
  expectMistake("sweep merge @/good.db -o /dev/null", 1, "/dev/null: is a device or a pipe");
}

TEST_F(SweepCliTest, APlanThatExcludesEverythingIsWrong) {
  writeTextFile(folder_ / "none.json",
                R"({"scenes": ["contact"], "maps": ["cube"], "biases": ["none"], "exclude": [{"map": "cube"}]})");
  for (const char* more : {"", " --dry-run"})
    expectMistake(std::string("sweep @/none.json --db @/none.db") + more, 2, "the plan has no case");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.db"));
}

TEST_F(SweepCliTest, FlagsWithoutEffectAreWrong) {
  expectMistake("sweep @/p.json --shards 3", 2, "--shards has no effect: it is for --slurm");
  expectMistake("sweep @/p.json --sbatch=--partition=long", 2, "--sbatch has no effect");
  expectMistake("sweep @/p.json --slurm-collect 1", 2, "--slurm-collect has no effect");
  expectMistake("sweep @/p.json --slurm --dry-run", 2, "--dry-run has no effect");
  expectMistake("sweep @/p.json --slurm --shard 1/2", 2, "--shard has no effect");
  expectMistake("sweep @/p.json -o @/all.db", 2, "--out has no effect");
  expectMistake("sweep merge @/a.db --shards 3 -o @/all.db", 2, "--shards has no effect: merge takes stores and -o");
}

// A sweep has one device and one scene at a time, and so its memory is that of one.
TEST_F(SweepCliTest, ADryRunTellsAboutTheMemoryOfTheSweep) {
  if (GNOMON_SANITIZE) GTEST_SKIP() << "a sanitizer keeps what is freed";
  writeTextFile(folder_ / "large.json", R"({"scenes": ["atrium"], "size": "768", "repeats": 1, "maps": ["cube"],
    "map_sizes": [1024], "biases": ["constant", "witness"]})");
  ASSERT_EQ(run("sweep @/large.json --db @/large.db").exitCode, 0);
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);  // of the largest so far, which is that
  const double swept = static_cast<double>(usage.ru_maxrss) / 1024.0;
  const std::string dry = run("sweep @/large.json --db @/absent.db --dry-run").out;
  double told = 0.0;
  const size_t at = dry.find("tried; ");
  ASSERT_NE(at, std::string::npos) << dry;
  ASSERT_EQ(std::sscanf(dry.c_str() + at, "tried; %lf MiB of memory", &told), 1) << dry;
  EXPECT_GT(told, 0.8 * swept);
  EXPECT_LT(told, 1.15 * swept);  // 1.06; with a second scene beside the first 1.27 and more
}

// As a kill at a store's start leaves it.
TEST_F(SweepCliTest, SlurmGoesOnWithAnEmptyStore) {
  std::filesystem::create_directory(folder_ / "all.db.slurm");
  writeTextFile(folder_ / "all.db", "");
  for (const char* shard : {"1", "2"})
    ASSERT_EQ(run(fmt::format("sweep @/p.json --shard {0}/2 --db @/all.db.slurm/part-{0}.db", shard)).exitCode, 0);
  const std::string collect = "sweep @/p.json --db @/all.db --slurm --shards 2 --slurm-collect ";
  const test::Result collected = run(collect + "1");
  EXPECT_EQ(collected.exitCode, 0) << collected.err;
  ASSERT_EQ(run("sweep @/p.json --db @/whole.db").exitCode, 0);
  EXPECT_EQ(contents("all.db"), contents("whole.db"));
  // A part that is empty has nothing to merge, and after the last submission is told as a failure.
  std::filesystem::remove(folder_ / "all.db");
  writeTextFile(folder_ / "all.db.slurm" / "part-2.db", "");
  const test::Result partly = run(collect + "3");
  EXPECT_EQ(partly.exitCode, 1);
  EXPECT_NE(partly.err.find("shards 2 failed 3 times"), std::string::npos) << partly.err;
  EXPECT_NE(partly.out.find("wrote "), std::string::npos) << partly.out;
}

TEST_F(SweepCliTest, WhatSlurmRefusesLeavesNoFolder) {
  const auto submit = [&](const char* text) {
    writeTextFile(folder_ / "bin" / "sbatch", text);
    std::filesystem::permissions(folder_ / "bin" / "sbatch", std::filesystem::perms::owner_all);
    return run("sweep @/p.json --slurm --db @/deep/all.db --device llvmpipe");
  };
  std::filesystem::create_directory(folder_ / "bin");
  const std::string path = std::getenv("PATH") != nullptr ? std::getenv("PATH") : "";
  ::setenv("PATH", ((folder_ / "bin").string() + ":" + path).c_str(), 1);
  const test::Result refused = submit("#!/bin/sh\necho no such partition\nexit 1\n");
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_NE(refused.err.find("refused the job: no such partition"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "deep"));
  EXPECT_EQ(submit("#!/bin/sh\necho 7\n").exitCode, 0);
  writeTextFile(folder_ / "deep" / "all.db", "");
  const test::Result intoEmpty = submit("#!/bin/sh\necho 7\n");
  EXPECT_EQ(intoEmpty.exitCode, 0) << intoEmpty.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "deep" / "all.db.slurm" / "collect.sh"));
  ::setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace gnomon
