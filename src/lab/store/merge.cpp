#include "lab/store/store.h"

#include "base/error.h"
#include "base/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <map>

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

void findConflicts(sql::Database& all, MergeReport& report) {
  std::string left, right, differ;
  std::string columns;
  for (const char* c :
       {"scored", "agree", "acne", "leak", "edge_shadow", "edge_light", "uncovered", "grazing", "edge_on", "rmse"}) {
    differ += fmt::format("{}a.{} IS NOT b.{}", differ.empty() ? "" : " OR ", c, c);
    columns += fmt::format(", a.{0} || ' and ' || b.{0} AS {0}", c);
  }
  sql::Statement conflicts =
      all.prepare(fmt::format("SELECT t.scene, t.light, t.camera, t.map, t.map_size, a.method, a.filter{} FROM "
                              "part.result a JOIN main.result b "
                              "USING(key) JOIN part.tested t ON t.key = a.tested WHERE {}",
                              columns, differ));
  while (conflicts.step())
    report.conflicts.push_back(fmt::format("{}, light {}, camera {}, {} {}, {}, filter {}: {}", conflicts.text(0),
                                           conflicts.text(1), conflicts.text(2), conflicts.text(3), conflicts.text(4),
                                           conflicts.text(5), conflicts.text(6), countsOf(conflicts, 7)));
}

void addPart(sql::Database& all, const fs::path& part, MergeReport& report) {
  Store(part, sql::Open::ReadOnly);  // that it is one
  all.prepare("ATTACH ? AS part").with(part.string()).run();
  {
    sql::Transaction transaction(all);
    findConflicts(all, report);
    report.rows += static_cast<size_t>(all.integerOf("SELECT count(*) FROM part.result"));
    const int64_t before = all.integerOf("SELECT count(*) FROM main.result");
    // Emptiness is settled once: a case with rows is not empty.
    for (const char* table : {"tested", "result", "medium", "picture", "worst", "failure"})
      all.execute(fmt::format("INSERT OR IGNORE INTO main.{0} SELECT * FROM part.{0}", table));
    // Of times of one machine the newer.
    all.execute(
        "INSERT INTO main.timing SELECT * FROM part.timing WHERE true ON CONFLICT(key, machine, device) DO UPDATE SET "
        "gbuffer_ms = excluded.gbuffer_ms, build_ms = excluded.build_ms, shade_ms = excluded.shade_ms, rounds = "
        "excluded.rounds, at = excluded.at WHERE excluded.at > timing.at");
    all.execute("INSERT OR IGNORE INTO main.note SELECT name, value FROM part.note WHERE name NOT LIKE 'shard %'");
    report.added += static_cast<size_t>(all.integerOf("SELECT count(*) FROM main.result") - before);
    transaction.commit();
  }
  all.execute("DETACH part");
}

// Of the rows of a slot the newest counts.
void settleSlots(sql::Database& all, MergeReport& report) {
  sql::Transaction transaction(all);
  for (const char* table : {"result", "medium"})
    all.execute(
        fmt::format("UPDATE {0} SET superseded = key <> (SELECT o.key FROM {0} o WHERE o.slot = {0}.slot ORDER BY "
                    "o.superseded, o.at "
                    "DESC, o.key LIMIT 1)",
                    table));
  all.execute("DELETE FROM failure WHERE key IN (SELECT tested FROM result)");
  report.superseded = static_cast<size_t>(all.integerOf("SELECT count(*) FROM result WHERE superseded"));
  transaction.commit();
}

void removeWithJournal(const fs::path& path) {
  std::error_code failure;
  for (const char* ending : {"", "-wal", "-shm", "-journal"}) fs::remove(path.string() + ending, failure);
}

}  // namespace

MergeReport mergeStores(const std::vector<fs::path>& parts, const fs::path& out) {
  checkOutput(out);
  const fs::path folder = out.parent_path().empty() ? "." : out.parent_path();
  fs::create_directories(folder);
  for (const fs::path& part : parts)
    if (!fs::exists(part)) throw fileError(part.string(), "does not exist", "name stores that gnomon sweep wrote");
  if (Workers::anyAt(out))
    throw fileError(out.string(), "is being worked on by another process", "wait until gnomon sweep has ended");
  const fs::path aside = asideIn(folder);
  MergeReport report;
  try {
    {
      Store all(aside, sql::Open::Create);
      all.database().execute("PRAGMA journal_mode=MEMORY; PRAGMA synchronous=OFF;");
      for (const fs::path& part : parts) addPart(all.database(), part, report);
      settleSlots(all.database(), report);
      all.database().execute("PRAGMA journal_mode=DELETE; PRAGMA synchronous=FULL;");
    }
    const Descriptor file(::open(aside.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file.isOpen() || ::fsync(file.get()) != 0)
      throw fileError(out.string(), "could not be written", "check the disk");
    // What an old store's journal holds is in it when its last reader has gone; its journal must not meet the new one.
    if (fs::exists(out)) Store(out, sql::Open::Existing).database().execute("PRAGMA wal_checkpoint(TRUNCATE)");
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
