// The store of a sweep: what it keeps, whose claims count, what a merge makes of several.
#include "lab/store/store.h"

#include "base/error.h"
#include "base/file.h"
#include "tests/base/places.h"
#include "tests/base/started_process.h"
#include "tests/base/temporary_folder.h"
#include "tests/lab/store_rows.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using test::caseOf;
using test::fill;
using test::kMachine;
using test::rowOf;
using test::TemporaryFolder;

const std::string kProcess = test::inBuild("tests/lab/store_process");

int64_t count(const Store& store, const std::string& of) {
  return store.database().integerOf("SELECT count(*) FROM " + of);
}

TEST(Store, KeepsACaseWholeAndNothingTwice) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "s.db";
  fill(path, {rowOf("k1", "s1"), rowOf("k2", "s2")});
  Store store(path, sql::Open::Existing);
  EXPECT_TRUE(store.has("k1", "s1"));
  EXPECT_FALSE(store.has("k3", "s1"));
  EXPECT_EQ(count(store, "results"), 2);
  EXPECT_EQ(store.database().textOf("SELECT bias_error || ' ' || frame_ms FROM results"), "0.01 6.0");
  EXPECT_FALSE(fs::exists(path.string() + "-workers"));  // nobody works on it any more
}

// Which all find none.
TEST(Store, ProcessesThatMakeItAtOnceShareIt) {
  for (int round = 0; round < 20; ++round) {
    const TemporaryFolder folder;
    std::array<int, 2> start{};
    ASSERT_EQ(::pipe2(start.data(), O_CLOEXEC), 0);
    const Descriptor waited(start[0]);
    Descriptor held(start[1]);
    std::vector<pid_t> processes;
    for (int i = 0; i < 6; ++i)
      processes.push_back(test::startProcess(
          {kProcess, "fill", (folder.path() / "s.db").string(), fmt::format("k{}", i), fmt::format("s{}", i)},
          {.in = waited.get()}));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    held = Descriptor();  // now all of them begin
    for (const pid_t process : processes) EXPECT_EQ(test::statusOf(process), 0);
    EXPECT_EQ(count(Store(folder.path() / "s.db", sql::Open::Existing), "results"), 6);
  }
}

TEST(Store, NewContentsSupersedeThoseOfTheirSlotAndBack) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "s.db";
  fill(path, {rowOf("old", "slot", 5), rowOf("other", "slot2")});
  fill(path, {rowOf("new", "slot", 7)});
  Store store(path, sql::Open::Existing);
  EXPECT_EQ(count(store, "result"), 3);
  EXPECT_EQ(count(store, "results WHERE acne = 7"), 1);
  EXPECT_EQ(count(store, "results"), 2);
  EXPECT_TRUE(store.has("old", "slot"));  // as where an edit of a scene is taken back
  EXPECT_EQ(count(store, "results WHERE acne = 5"), 1);
  EXPECT_EQ(count(store, "results"), 2);
}

TEST(Store, ClaimsOfTheLivingCountAndThoseOfTheDeadDoNot) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "s.db";
  fill(path, {rowOf("k", "s")});
  std::array<int, 2> ready{};
  ASSERT_EQ(::pipe2(ready.data(), O_CLOEXEC), 0);
  const Descriptor heard(ready[0]);
  Descriptor told(ready[1]);
  const pid_t process = test::startProcess({kProcess, "claim", path.string(), "work"}, {.out = told.get()});
  told = Descriptor();
  char said = 0;
  ASSERT_EQ(::read(heard.get(), &said, 1), 1);
  EXPECT_EQ(said, 'y');
  Store store(path, sql::Open::Existing);
  store.startWork(kMachine);
  EXPECT_FALSE(store.claim("work"));
  EXPECT_TRUE(store.claim("other work"));
  EXPECT_TRUE(Workers::anyAt(path));
  EXPECT_THROW(mergeStores({path}, path), WorldError);  // somebody works on it
  ::kill(process, SIGKILL);
  test::statusOf(process);
  EXPECT_TRUE(store.claim("work"));
  store.release("work");
  Store third(path, sql::Open::Existing);
  third.startWork(kMachine);
  EXPECT_TRUE(third.claim("work"));
  EXPECT_FALSE(third.claim("other work"));
}

TEST(Store, MergeTellsConflictsAndWhatTheLastStoreReplaces) {
  const TemporaryFolder folder;
  const fs::path a = folder.path() / "a.db", b = folder.path() / "b.db", all = folder.path() / "all.db";
  fill(a, {rowOf("same", "s1"), rowOf("conflict", "s2", 3), rowOf("old", "s3", 1)});
  fill(b, {rowOf("same", "s1"), rowOf("conflict", "s2", 4), rowOf("new", "s3", 2), rowOf("more", "s4")});
  // The last store counts, whatever its machine's clock says.
  Store(b, sql::Open::Existing).database().execute("UPDATE result SET at = at - 1000, version = '1-b'");
  const MergeReport report = mergeStores({a, b}, all);
  EXPECT_EQ(report.rows, 7u);
  EXPECT_EQ(report.added, 5u);
  EXPECT_EQ(report.superseded, 1u);
  ASSERT_EQ(report.conflicts.size(), 1u);
  EXPECT_NE(report.conflicts[0].find("acne 3 and 4"), std::string::npos) << report.conflicts[0];
  ASSERT_EQ(report.replaced.size(), 1u);
  EXPECT_NE(report.replaced[0].find("scene: 1 rows of "), std::string::npos) << report.replaced[0];
  EXPECT_NE(report.replaced[0].find("another is the results' version"), std::string::npos) << report.replaced[0];
  ASSERT_EQ(report.mixtures.size(), 1u);
  EXPECT_EQ(report.mixtures[0], "rows of several: version 1-a; 1-b");
  const Store merged(all, sql::Open::Existing);
  EXPECT_EQ(count(merged, "results"), 4);
  EXPECT_EQ(count(merged, "results WHERE key = 'new'"), 1);
  EXPECT_EQ(count(merged, "results WHERE key = 'conflict' AND acne = 3"), 1);
  EXPECT_EQ(mergeStores({all, a}, all).conflicts.size(), 0u);  // into itself
}

TEST(Store, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  writeTextFile(folder.path() / "text", std::string(5000, 'x'));
  EXPECT_THROW(Store(folder.path() / "text", sql::Open::Create), WorldError);
  EXPECT_THROW(Store(folder.path() / "none.db", sql::Open::Existing), WorldError);
  sql::Database other(folder.path() / "other.db", sql::Open::Create);
  other.execute("CREATE TABLE t(x)");
  EXPECT_THROW(Store(folder.path() / "other.db", sql::Open::Create), WorldError);
}

std::string complaintOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const WorldError& error) {
    return error.what();
  }
  return "none";
}

// Read as report and merge read: whatever bytes of its head are wrong, no journal stays beside it.
TEST(Store, ADamagedStoreThatIsReadIsLeftAlone) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.db";
  fill(path, {rowOf("k", "s")});
  const std::string whole = readFile(path);
  const auto read = [&](const std::string& bytes) {
    writeTextFile(path, bytes);
    try {
      const Store store(path, sql::Open::ReadOnly);
      EXPECT_THROW(store.database().prepare("DELETE FROM result").run(), WorldError);
      count(store, "results");
    } catch (const WorldError&) {
    }
    EXPECT_THROW(mergeStores({path, folder.path() / "absent.db"}, folder.path() / "all.db"), WorldError);
    try {
      mergeStores({path}, folder.path() / "all.db");
    } catch (const WorldError& error) {
      EXPECT_NE(std::string(error.what()).find("a.db: "), std::string::npos) << error.what();
    }
    fs::remove(folder.path() / "all.db");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
    return readFile(path);
  };
  EXPECT_EQ(read(whole), whole);
  for (const size_t size : {size_t{16}, size_t{99}, size_t{600}, size_t{4096}, size_t{6000}, whole.size() - 4096})
    EXPECT_EQ(read(whole.substr(0, size)), whole.substr(0, size)) << size;
  for (size_t at = 16; at < 120; ++at) {
    std::string wrong = whole;
    wrong[at] = static_cast<char>(wrong[at] ^ 0x55);
    SCOPED_TRACE(at);
    read(wrong);
  }
}

TEST(Store, AFullDiskIsToldAndWhatWasStoredStays) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "s.db";
  fill(path, {rowOf("k", "s")});
  size_t put = 0;
  {
    Store store(path, sql::Open::Existing);
    store.startWork(kMachine);
    // As a disk with room for twenty pages more is: SQLITE_FULL either way.
    const int64_t pages = store.database().integerOf("PRAGMA page_count");
    store.database().execute(fmt::format("PRAGMA max_page_count={}", pages + 20));
    std::string complaint = "none";
    while (complaint == "none" && put < 10000) {
      complaint = complaintOf([&] {
        store.put(caseOf(fmt::format("case{}", put)), {rowOf(fmt::format("a{}", put), fmt::format("as{}", put)),
                                                       rowOf(fmt::format("b{}", put), fmt::format("bs{}", put))});
      });
      if (complaint == "none") ++put;
    }
    EXPECT_NE(complaint.find("s.db"), std::string::npos) << complaint;
    EXPECT_NE(complaint.find("make room"), std::string::npos) << complaint;
    EXPECT_EQ(complaint.find('\n'), std::string::npos);
  }
  EXPECT_GT(put, 0u);
  Store store(path, sql::Open::Existing);
  EXPECT_EQ(store.database().textOf("PRAGMA integrity_check"), "ok");
  EXPECT_EQ(count(store, "results"), static_cast<int64_t>(1 + 2 * put));  // cases whole or not at all
  store.startWork(kMachine);
  store.put(caseOf("more"), {rowOf("more", "more")});  // there is room again
  EXPECT_EQ(count(store, "results"), static_cast<int64_t>(2 + 2 * put));
}

TEST(Store, ALockedStoreIsToldAndNothingIsLost) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "s.db";
  fill(path, {rowOf("k", "s")});
  Store store(path, sql::Open::Existing);
  store.startWork(kMachine);
  store.database().setPatience(20);
  sql::Database other(path, sql::Open::Existing);
  {
    sql::Transaction transaction(other);
    const std::string complaint = complaintOf([&] { store.put(caseOf("more"), {rowOf("more", "more")}); });
    EXPECT_NE(complaint.find("another program holds it"), std::string::npos) << complaint;
    EXPECT_EQ(count(store, "results"), 1);
  }
  store.put(caseOf("more"), {rowOf("more", "more")});
  EXPECT_EQ(count(store, "results"), 2);
}

TEST(Store, OnlyPicturesOfTheWorstAreKeptAndEachOnce) {
  const TemporaryFolder folder;
  Store store(folder.path() / "s.db", sql::Open::Create);
  store.startWork(kMachine);
  std::vector<StoredRow> rows;
  for (size_t i = 0; i < 6; ++i) {
    rows.push_back(rowOf(fmt::format("k{}", i), fmt::format("s{}", i), i));
    rows.back().pictures.push_back({"acne", i < 4 ? "png" : "another"});
  }
  store.put(caseOf("case"), rows);
  EXPECT_EQ(count(store, "picture"), 2);
  EXPECT_EQ(store.worstErrors(2), (std::map<std::string, std::vector<double>>{{"none", {0.05, 0.04}}}));
  store.keepWorstPictures(2);
  EXPECT_EQ(count(store, "pictures"), 2);
  EXPECT_EQ(count(store, "picture"), 1);
}

}  // namespace
}  // namespace gnomon
