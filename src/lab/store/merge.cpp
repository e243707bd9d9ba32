#include "lab/store/store.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"

#include <fcntl.h>
#include <unistd.h>

#include <optional>
#include <vector>

#include <fmt/format.h>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

std::string countsOf(const sql::Statement& row, int from) {
  std::string text;
  for (int i = from; i < row.columnCount(); ++i)
    text += fmt::format("{}{} {}", i == from ? "" : ", ", row.columnName(i), row.text(i));
  return text;
}

// Rows of one key with other contents than before.
void findConflicts(sql::Database& all, const char* table, const char* name, const std::vector<std::string>& columns,
                   MergeReport& report) {
  std::string both, differ;
  for (const std::string& column : columns) {
    differ += fmt::format("{}a.{} IS NOT b.{}", differ.empty() ? "" : " OR ", column, column);
    both += fmt::format(", b.{0} || ' and ' || a.{0} AS {0}", column);
  }
  sql::Statement conflicts = all.prepare(
      fmt::format("SELECT t.scene, t.light, t.camera, t.map, t.map_size, {}{} FROM part.{} a JOIN main.{} b USING(key) "
                  "JOIN part.tested t ON t.key = a.tested WHERE {}",
                  name, both, table, table, differ));
  while (conflicts.step())
    report.conflicts.push_back(fmt::format("{}, light {}, camera {}, {} {}, {}: {}", conflicts.text(0),
                                           conflicts.text(1), conflicts.text(2), conflicts.text(3), conflicts.text(4),
                                           conflicts.text(5), countsOf(conflicts, 6)));
}

// Places of the plan (slots) where the part has other contents than the parts before it; they are the part's from now
// on.
void replacePlaces(sql::Database& all, const char* table, const fs::path& part, MergeReport& report) {
  sql::Statement found = all.prepare(fmt::format(
      "SELECT t.scene, count(*), max(t.scene_hash <> u.scene_hash), max(a.version <> b.version), max(a.device <> "
      "b.device OR a.driver <> b.driver) FROM part.{0} a JOIN place p ON p.slot = a.slot AND p.key <> a.key JOIN "
      "main.{0} b ON b.key = p.key JOIN part.tested t ON t.key = a.tested JOIN main.tested u ON u.key = b.tested WHERE "
      "NOT a.superseded GROUP BY t.scene ORDER BY t.scene",
      table));
  while (found.step()) {
    std::string why;
    const char* kReasons[] = {"the scene's contents", "the results' version", "the device"};
    for (int i = 0; i < 3; ++i)
      if (found.integer(2 + i) != 0) why += (why.empty() ? "" : ", ") + std::string(kReasons[i]);
    if (why.empty()) why = "a light, a camera or a bias of the same name";
    report.replaced.push_back(fmt::format("{}: {} rows of {} replace those of the stores before it, for another is {}",
                                          found.text(0), found.integer(1), part.string(), why));
  }
  all.execute(fmt::format("INSERT OR REPLACE INTO place SELECT slot, key FROM part.{} WHERE NOT superseded", table));
}

// All of it is read, so that what is damaged is told by its own name, before anything is made.
void checkPart(const fs::path& part) {
  const Store store(part, sql::Open::ReadOnly);
  const std::optional<std::string> found = store.database().textOf("PRAGMA quick_check(1)");
  if (found == "ok") return;
  // Below a heading, "*** in database main ***".
  const std::string& told = found.value_or("");
  const size_t heading = told.starts_with("***") ? told.find('\n') + 1 : 0;
  throw fileError(part.string(), "is damaged: " + oneLine(told.substr(heading, 160)),
                  "save what is left with: sqlite3 FILE .recover");
}

void addPart(sql::Database& all, const fs::path& part, MergeReport& report) {
  try {
    all.prepare("ATTACH ? AS part").with(part.string()).run();
  } catch (const WorldError& error) {  // which names the store that is being made
    if (std::string_view(error.what()).find("is locked") != std::string_view::npos)
      throw fileError(part.string(), "is locked by another process", "wait until it has ended");
    throw fileError(part.string(), "cannot be merged: its head is damaged",
                    "save what is left with: sqlite3 FILE .recover");
  }
  {
    sql::Transaction transaction(all);
    findConflicts(
        all, "result", "a.method || ', filter ' || a.filter",
        {"scored", "agree", "acne", "leak", "edge_shadow", "edge_light", "uncovered", "grazing", "edge_on", "rmse"},
        report);
    findConflicts(all, "medium", "a.integrator", {"rel_rmse", "rel_rmse_99"}, report);
    replacePlaces(all, "result", part, report);
    replacePlaces(all, "medium", part, report);
    const auto rowsOf = [&](const char* store) {
      return static_cast<size_t>(all.integerOf(
          fmt::format("SELECT (SELECT count(*) FROM {0}.result) + (SELECT count(*) FROM {0}.medium)", store)));
    };
    report.rows += rowsOf("part");
    const size_t before = rowsOf("main");
    for (const char* table : {"tested", "result", "medium", "picture", "worst", "failure"})
      all.execute(fmt::format("INSERT OR IGNORE INTO main.{0} SELECT * FROM part.{0}", table));
    // Of times of one machine the newer.
    all.execute(
        "INSERT INTO main.timing SELECT * FROM part.timing WHERE true ON CONFLICT(key, machine, device) DO UPDATE SET "
        "gbuffer_ms = excluded.gbuffer_ms, build_ms = excluded.build_ms, shade_ms = excluded.shade_ms, rounds = "
        "excluded.rounds, at = excluded.at WHERE excluded.at > timing.at");
    all.execute("INSERT OR IGNORE INTO main.note SELECT name, value FROM part.note WHERE name NOT LIKE 'shard %'");
    report.added += rowsOf("main") - before;
    transaction.commit();
  }
  all.execute("DETACH part");
}

// What parts that should be of one sweep do not have in common.
void findMixtures(const sql::Database& all, MergeReport& report) {
  sql::Statement scenes = all.prepare(
      "SELECT scene, count(DISTINCT scene_hash) AS n FROM results GROUP BY scene HAVING n > 1 ORDER BY scene");
  while (scenes.step())
    report.mixtures.push_back(
        fmt::format("{}: rows of {} scenes of this name, with other contents", scenes.text(0), scenes.integer(1)));
  for (const char* column : {"version", "device", "driver"}) {
    if (all.integerOf(fmt::format("SELECT count(DISTINCT {}) FROM results", column)) < 2) continue;
    report.mixtures.push_back(
        fmt::format("rows of several: {} {}", column,
                    *all.textOf(fmt::format(
                        "SELECT group_concat({0}, '; ') FROM (SELECT DISTINCT {0} FROM results ORDER BY 1)", column))));
  }
}

void settle(Store& store, MergeReport& report) {
  sql::Database& all = store.database();
  sql::Transaction transaction(all);
  for (const char* table : {"result", "medium"})
    all.execute(fmt::format(
        "UPDATE {0} SET superseded = key IS NOT (SELECT p.key FROM place p WHERE p.slot = {0}.slot)", table));
  for (const char* table : {"result", "medium"}) {
    all.execute(fmt::format("UPDATE tested SET empty = NULL WHERE key IN (SELECT tested FROM {})", table));
    all.execute(fmt::format("DELETE FROM failure WHERE key IN (SELECT tested FROM {})", table));
  }
  report.superseded = static_cast<size_t>(all.integerOf("SELECT count(*) FROM result WHERE superseded"));
  findMixtures(all, report);
  transaction.commit();
  if (const std::optional<std::string> most = store.note(kWorstPicturesNote)) store.keepWorstPictures(std::stoi(*most));
}

void removeWithJournal(const fs::path& path) {
  std::error_code failure;
  for (const char* ending : {"", "-wal", "-shm", "-journal"}) fs::remove(path.string() + ending, failure);
}

}  // namespace

MergeReport mergeStores(const std::vector<fs::path>& parts, const fs::path& out) {
  checkOutput(out);
  for (const fs::path& part : parts) checkPart(part);
  if (fs::exists(out) && !fs::is_regular_file(out))
    throw fileError(out.string(), "is a device or a pipe, and no file", "name a file");
  if (Workers::anyAt(out))
    throw fileError(out.string(), "is being worked on by another process", "wait until gnomon sweep has ended");
  const fs::path folder = out.parent_path().empty() ? "." : out.parent_path();
  fs::create_directories(folder);
  const fs::path aside = asideIn(folder);
  MergeReport report;
  try {
    {
      Store all(aside, sql::Open::Create);
      all.database().execute("PRAGMA journal_mode=MEMORY; PRAGMA synchronous=OFF;");
      all.database().execute("CREATE TEMP TABLE place(slot TEXT PRIMARY KEY, key TEXT NOT NULL) WITHOUT ROWID");
      for (const fs::path& part : parts) addPart(all.database(), part, report);
      settle(all, report);
      all.database().execute("PRAGMA journal_mode=DELETE; PRAGMA synchronous=FULL;");
    }
    const Descriptor file(::open(aside.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.isOpen() || ::fsync(file.get()) != 0)
      throw fileError(out.string(), "could not be written", "check the disk");
    // What an old store's journal holds is in it when its last reader has gone; its journal must not meet the new one.
    if (isStoreThere(out)) Store(out, sql::Open::Existing).database().execute("PRAGMA wal_checkpoint(TRUNCATE)");
    std::error_code failure;
    for (const char* ending : {"-wal", "-shm"}) fs::remove(out.string() + ending, failure);
    fs::rename(aside, out);
  } catch (const std::filesystem::filesystem_error& error) {
    removeWithJournal(aside);
    throw fileError(out.string(), error.code().message(), "check the folder and its permissions");
  } catch (...) {
    removeWithJournal(aside);
    throw;
  }
  return report;
}

}  // namespace gnomon
