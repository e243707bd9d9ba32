#include "lab/store/store.h"

#include "base/check.h"
#include "base/error.h"
#include "base/message.h"
#include "lab/results/results_file.h"
#include "lab/store/content_hash.h"

#include <unistd.h>

#include <ctime>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

constexpr const char* kTables = R"(
CREATE TABLE IF NOT EXISTS note(name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS worker(id INTEGER PRIMARY KEY AUTOINCREMENT, host TEXT, pid INTEGER, started INTEGER);
CREATE TABLE IF NOT EXISTS claim(work TEXT PRIMARY KEY, worker INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS tested(
  key TEXT PRIMARY KEY,
  scene TEXT NOT NULL, scene_hash TEXT NOT NULL, scene_source TEXT NOT NULL, triangles INTEGER NOT NULL,
  diagonal REAL NOT NULL, light TEXT NOT NULL, light_type TEXT NOT NULL, camera TEXT NOT NULL,
  width INTEGER NOT NULL, height INTEGER NOT NULL, map TEXT NOT NULL, map_options TEXT NOT NULL,
  map_size INTEGER NOT NULL, lit INTEGER NOT NULL, margin_flips_half INTEGER NOT NULL,
  margin_flips_double INTEGER NOT NULL, texel REAL, empty TEXT);
CREATE TABLE IF NOT EXISTS result(
  key TEXT PRIMARY KEY, slot TEXT NOT NULL, superseded INTEGER NOT NULL DEFAULT 0,
  tested TEXT NOT NULL REFERENCES tested(key),
  bias TEXT NOT NULL, method TEXT NOT NULL, parameters TEXT NOT NULL, tuned INTEGER NOT NULL, filter TEXT NOT NULL,
  layers INTEGER NOT NULL, map_texels INTEGER NOT NULL, map_bytes INTEGER NOT NULL,
  scored INTEGER NOT NULL, agree INTEGER NOT NULL, acne INTEGER NOT NULL, leak INTEGER NOT NULL,
  edge_shadow INTEGER NOT NULL, edge_light INTEGER NOT NULL, uncovered INTEGER NOT NULL,
  unseen_occluder INTEGER, unseen_surface INTEGER, grazing INTEGER NOT NULL, edge_on INTEGER NOT NULL,
  rmse REAL NOT NULL, worst_acne TEXT, worst_leak TEXT, command TEXT NOT NULL,
  version TEXT NOT NULL, program TEXT NOT NULL, device TEXT NOT NULL, driver TEXT NOT NULL, at INTEGER NOT NULL);
CREATE INDEX IF NOT EXISTS result_slot ON result(slot);
CREATE INDEX IF NOT EXISTS result_method ON result(method, superseded);
CREATE TABLE IF NOT EXISTS medium(
  key TEXT PRIMARY KEY, slot TEXT NOT NULL, superseded INTEGER NOT NULL DEFAULT 0,
  tested TEXT NOT NULL REFERENCES tested(key),
  integrator TEXT NOT NULL, steps INTEGER, medium TEXT NOT NULL, rel_rmse REAL, rel_rmse_99 REAL, command TEXT NOT NULL,
  version TEXT NOT NULL, program TEXT NOT NULL, device TEXT NOT NULL, driver TEXT NOT NULL, at INTEGER NOT NULL);
CREATE INDEX IF NOT EXISTS medium_slot ON medium(slot);
CREATE TABLE IF NOT EXISTS timing(
  key TEXT NOT NULL, machine TEXT NOT NULL, device TEXT NOT NULL, gbuffer_ms REAL NOT NULL, build_ms REAL NOT NULL,
  shade_ms REAL NOT NULL,
  rounds INTEGER NOT NULL, at INTEGER NOT NULL, PRIMARY KEY(key, machine, device)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS picture(hash TEXT PRIMARY KEY, png BLOB NOT NULL);
CREATE TABLE IF NOT EXISTS worst(key TEXT NOT NULL, kind TEXT NOT NULL, picture TEXT NOT NULL REFERENCES picture(hash),
  PRIMARY KEY(key, kind)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS failure(
  key TEXT PRIMARY KEY, scene TEXT, light TEXT, camera TEXT, map TEXT, map_size INTEGER, message TEXT, at INTEGER);
)";

// One row a key: the times of the machine that measured last.
constexpr const char* kViews = R"(
DROP VIEW IF EXISTS results;
CREATE VIEW results AS
SELECT t.scene, t.light, t.camera, t.map, t.map_size, r.bias, r.method, r.filter,
  r.scored, r.agree, r.acne, r.leak, r.edge_shadow, r.edge_light, r.uncovered,
  CAST(r.acne + r.leak AS REAL) / r.scored AS bias_error, CAST(r.scored - r.agree AS REAL) / r.scored AS all_wrong,
  r.rmse, x.gbuffer_ms, x.build_ms, x.shade_ms, x.gbuffer_ms + x.build_ms + x.shade_ms AS frame_ms,
  r.parameters, r.tuned, r.map_texels, r.map_bytes, r.layers, t.map_options, t.light_type, t.width, t.height, t.lit,
  t.texel, t.margin_flips_half, t.margin_flips_double, r.unseen_occluder, r.unseen_surface, r.grazing, r.edge_on,
  r.worst_acne, r.worst_leak, t.triangles, t.diagonal, t.scene_source, t.scene_hash, x.machine, x.rounds,
  r.command, r.version, r.program, r.device, r.driver, r.key, r.tested
FROM result r JOIN tested t ON t.key = r.tested
LEFT JOIN timing x ON x.key = r.key AND x.machine || x.device =
  (SELECT y.machine || y.device FROM timing y WHERE y.key = r.key ORDER BY y.at DESC, y.machine LIMIT 1)
WHERE NOT r.superseded;
DROP VIEW IF EXISTS media_results;
CREATE VIEW media_results AS
SELECT t.scene, t.light, t.camera, m.medium, m.integrator, m.steps, t.map, t.map_size, m.rel_rmse, m.rel_rmse_99,
  x.build_ms, x.shade_ms AS integrate_ms, t.width, t.height, x.machine, m.command, m.version,
  m.program, m.device, m.driver, m.key
FROM medium m JOIN tested t ON t.key = m.tested
LEFT JOIN timing x ON x.key = m.key AND x.machine || x.device =
  (SELECT y.machine || y.device FROM timing y WHERE y.key = m.key ORDER BY y.at DESC, y.machine LIMIT 1)
WHERE NOT m.superseded;
DROP VIEW IF EXISTS methods;
CREATE VIEW methods AS
SELECT method, filter, count(*) AS cases, avg(bias_error) AS mean_bias_error, max(bias_error) AS worst_bias_error,
  avg(all_wrong) AS mean_all_wrong, avg(rmse) AS mean_rmse, avg(build_ms) AS mean_build_ms,
  avg(shade_ms) AS mean_shade_ms
FROM results GROUP BY method, filter;
DROP VIEW IF EXISTS scenes;
CREATE VIEW scenes AS
SELECT scene, method, filter, map, map_size, count(*) AS cases, avg(bias_error) AS mean_bias_error,
  avg(all_wrong) AS mean_all_wrong FROM results GROUP BY scene, method, filter, map, map_size;
DROP VIEW IF EXISTS pictures;
CREATE VIEW pictures AS SELECT w.key, w.kind, p.png FROM worst w JOIN picture p ON p.hash = w.picture;
)";

int64_t now() {
  return static_cast<int64_t>(std::time(nullptr));
}

std::optional<std::string> placeText(const std::optional<WorstPlace>& place) {
  if (!place) return std::nullopt;
  return fmt::format("{},{},{},{}", place->x, place->y, place->size, place->pixels.value_or(0));
}

std::string paramsJson(const Params& params) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Param& param : params) std::visit([&](const auto& value) { json[param.name] = value; }, param.value);
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

int64_t count(size_t value) {
  return static_cast<int64_t>(value);
}

std::optional<int64_t> count(const std::optional<size_t>& value) {
  return value ? std::optional(count(*value)) : std::nullopt;
}

void putCase(const sql::Database& database, const StoredCase& of, const std::optional<std::string>& empty) {
  database.prepare("INSERT OR REPLACE INTO tested VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)")
      .with(of.key, of.scene, of.sceneHash, of.sceneSource, count(of.triangles), of.diagonal, of.light, of.lightType,
            of.camera, of.width, of.height, of.map, of.mapOptions, of.mapSize, count(of.lit), count(of.marginFlipsHalf),
            count(of.marginFlipsDouble), of.texel, empty)
      .run();
}

}  // namespace

bool isStoreThere(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) return false;
  return !std::filesystem::is_regular_file(path) || std::filesystem::file_size(path, failure) > 0;
}

// Before this process opens the store: closing any descriptor of a file lets go its locks there, SQLite's among them.
void checkStorePath(const std::filesystem::path& path, sql::Open how) {
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  constexpr const char* kRemedy = "name a file that gnomon sweep wrote";
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) {
    if (how == sql::Open::Create || !std::filesystem::status_known(status)) return;  // SQLite says more
    throw fileError(path.string(), "does not exist", kRemedy);
  }
  if (std::filesystem::is_directory(status)) throw fileError(path.string(), "is a folder", kRemedy);
  if (!std::filesystem::is_regular_file(status))
    throw fileError(path.string(), "is a device or a pipe, and no file", kRemedy);
  std::ifstream file(path, std::ios::binary);
  if (!file) return;
  char head[kMagic.size()] = {};
  file.read(head, sizeof(head));
  const std::string_view found(head, static_cast<size_t>(file.gcount()));
  if (found.empty() && how != sql::Open::Create) throw fileError(path.string(), "is empty", kRemedy);
  if (!found.empty() && found != kMagic) throw fileError(path.string(), "is no SQLite file", kRemedy);
}

Store::Store(const std::filesystem::path& path, sql::Open how) : database_((checkStorePath(path, how), path), how) {
  int64_t version = database_.integerOf("PRAGMA user_version");
  const bool isNew =
      version == 0 && how == sql::Open::Create && database_.integerOf("SELECT count(*) FROM sqlite_master") == 0;
  // Another process may have made it in between.
  if (!isNew && version == 0) version = database_.integerOf("PRAGMA user_version");
  if (!isNew && version != kStoreVersion)
    throw fileError(path.string(),
                    version == 0 ? "is a database of something else" : fmt::format("has version {}", version),
                    fmt::format("name a store of gnomon sweep, version {}", kStoreVersion));
  if (how == sql::Open::ReadOnly) return;
  database_.useWriteAheadLog();
  database_.execute("PRAGMA synchronous=NORMAL");
  if (!isNew) return;
  sql::Transaction transaction(database_);
  if (database_.integerOf("PRAGMA user_version") == 0) {  // else another process was faster
    database_.execute(kTables);
    database_.execute(kViews);
    database_.execute(fmt::format("PRAGMA user_version={}", kStoreVersion));
  }
  transaction.commit();
}

Store::~Store() {
  if (worker_ == 0) return;
  try {
    database_.prepare("DELETE FROM claim WHERE worker=?").with(worker_).run();
    database_.prepare("DELETE FROM worker WHERE id=?").with(worker_).run();
  } catch (const WorldError&) {  // whoever comes next sees that this worker is dead
  }
}

void Store::startWork(const Machine& machine) {
  machine_ = machine;
  workers_ = std::make_unique<Workers>(database_.path());
  sql::Transaction transaction(database_);
  // Numbers are never given twice, so that a dead worker's claims are never taken for a living one's.
  database_.prepare("INSERT INTO worker(host, pid, started) VALUES(?,?,?)")
      .with(machine.host, int64_t{::getpid()}, now())
      .run();
  worker_ = database_.lastRowId();
  GNOMON_CHECK(workers_->become(worker_));
  sql::Statement claims = database_.prepare("SELECT DISTINCT worker FROM claim");
  std::vector<int64_t> dead;
  while (claims.step())
    if (claims.integer(0) != worker_ && !workers_->isAlive(claims.integer(0))) dead.push_back(claims.integer(0));
  for (const int64_t id : dead) {
    database_.prepare("DELETE FROM claim WHERE worker=?").with(id).run();
    database_.prepare("DELETE FROM worker WHERE id=?").with(id).run();
  }
  transaction.commit();
}

void Store::supersede(const char* table, const std::string& key, const std::string& slot) {
  database_.prepare(fmt::format("UPDATE {} SET superseded = (key <> ?) WHERE slot = ?", table)).with(key, slot).run();
}

bool Store::has(const std::string& key, const std::string& slot) {
  for (const char* table : {"result", "medium"}) {
    sql::Statement found =
        database_.prepare(fmt::format("SELECT superseded, slot FROM {} WHERE key=?", table)).with(key);
    if (!found.step()) continue;
    if (found.integer(0) != 0 && found.text(1) == slot) {
      found.reset();
      sql::Transaction transaction(database_);
      supersede(table, key, slot);
      transaction.commit();
    }
    return true;
  }
  return false;
}

bool Store::isEmpty(const std::string& caseKey) const {
  sql::Statement found = database_.prepare("SELECT 1 FROM tested WHERE key=? AND empty IS NOT NULL").with(caseKey);
  return found.step();
}

bool Store::claim(const std::string& work) {
  GNOMON_CHECK(worker_ != 0);
  sql::Transaction transaction(database_);
  {
    sql::Statement found = database_.prepare("SELECT worker FROM claim WHERE work=?").with(work);
    if (found.step() && found.integer(0) != worker_ && workers_->isAlive(found.integer(0))) return false;
  }
  database_.prepare("INSERT OR REPLACE INTO claim VALUES(?,?)").with(work, worker_).run();
  transaction.commit();
  return true;
}

void Store::release(const std::string& work) {
  database_.prepare("DELETE FROM claim WHERE work=? AND worker=?").with(work, worker_).run();
}

void Store::put(const StoredCase& of, const std::vector<StoredRow>& rows, const std::vector<StoredMedium>& media) {
  sql::Transaction transaction(database_);
  putCase(database_, of, std::nullopt);
  database_.prepare("DELETE FROM failure WHERE key=?").with(of.key).run();
  sql::Statement insert = database_.prepare(
      "INSERT OR REPLACE INTO result VALUES(?,?,0,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
  sql::Statement time = database_.prepare("INSERT OR REPLACE INTO timing VALUES(?,?,?,?,?,?,?,?)");
  const auto putTimes = [&](const std::string& key, const std::optional<StoredTimes>& times) {
    if (!times) return;
    time.with(key, machine_.host, machine_.device, times->gbufferMs, times->buildMs, times->shadeMs, times->rounds,
              now())
        .run();
  };
  for (const auto& [key, slot, method, row, times, pictures] : rows) {
    insert
        .with(key, slot, of.key, row.bias, method, paramsJson(row.params), row.isTuned(), row.filter, row.layers,
              count(row.mapTexels), count(row.mapBytes), count(row.scored), count(row.agree), count(row.acne),
              count(row.leak), count(row.edgeShadow), count(row.edgeLight), count(row.uncovered),
              count(row.unseenOccluder), count(row.unseenSurface), count(row.grazing), count(row.edgeOn), row.rmse,
              placeText(row.worstAcne), placeText(row.worstLeak), row.command, machine_.results, machine_.program,
              machine_.device, machine_.driver, now())
        .run();
    supersede("result", key, slot);
    putTimes(key, times);
    for (const auto& [kind, png] : pictures) {
      const std::string hash = hashOf(png);
      sql::Statement picture = database_.prepare("INSERT OR IGNORE INTO picture VALUES(?,?)");
      picture.bind(0, hash);
      picture.bindBlob(1, png);
      picture.run();
      database_.prepare("INSERT OR REPLACE INTO worst VALUES(?,?,?)").with(key, kind, hash).run();
    }
  }
  for (const StoredMedium& medium : media) {
    database_.prepare("INSERT OR REPLACE INTO medium VALUES(?,?,0,?,?,?,?,?,?,?,?,?,?,?,?)")
        .with(medium.key, medium.slot, of.key, medium.integrator, medium.steps, medium.medium, medium.relRmse,
              medium.relRmse99, medium.command, machine_.results, machine_.program, machine_.device, machine_.driver,
              now())
        .run();
    supersede("medium", medium.key, medium.slot);
    putTimes(medium.key, medium.times);
  }
  transaction.commit();
}

void Store::putEmpty(const StoredCase& of, const std::string& reason) {
  sql::Transaction transaction(database_);
  putCase(database_, of, reason);
  transaction.commit();
}

void Store::putFailure(const StoredCase& of, const std::string& message) {
  database_.prepare("INSERT OR REPLACE INTO failure VALUES(?,?,?,?,?,?,?,?)")
      .with(of.key, of.scene, of.light, of.camera, of.map, of.mapSize, message, now())
      .run();
}

std::map<std::string, std::vector<double>> Store::worstErrors(int perMethod) const {
  std::map<std::string, std::vector<double>> worst;
  sql::Statement rows = database_.prepare(
      "SELECT method, e FROM (SELECT method, e, row_number() OVER (PARTITION BY method ORDER BY e DESC) AS place FROM "
      "(SELECT method, CAST(acne + leak AS REAL) / scored AS e FROM result WHERE NOT superseded)) WHERE place <= ? "
      "ORDER BY method, e DESC");
  rows.with(perMethod);
  while (rows.step()) worst[rows.text(0)].push_back(rows.number(1));
  return worst;
}

void Store::keepWorstPictures(int perMethod) {
  sql::Transaction transaction(database_);
  database_
      .prepare(
          "DELETE FROM worst WHERE key NOT IN (SELECT key FROM (SELECT key, row_number() OVER (PARTITION BY method "
          "ORDER BY CAST(acne + leak AS REAL) / scored DESC, key) AS place FROM result WHERE NOT superseded) WHERE "
          "place <= ?)")
      .with(perMethod)
      .run();
  database_.execute("DELETE FROM picture WHERE hash NOT IN (SELECT picture FROM worst)");
  transaction.commit();
}

void Store::setNote(const std::string& name, const std::string& value) {
  database_.prepare("INSERT OR REPLACE INTO note VALUES(?,?)").with(name, value).run();
}

std::optional<std::string> Store::note(const std::string& name) const {
  sql::Statement found = database_.prepare("SELECT value FROM note WHERE name=?").with(name);
  return found.step() ? std::optional(found.text(0)) : std::nullopt;
}

std::string machineName() {
  char host[256] = "";
  ::gethostname(host, sizeof(host) - 1);
  std::string processor = "unknown processor";
  std::ifstream facts("/proc/cpuinfo");
  for (std::string line; std::getline(facts, line);)
    if (line.starts_with("model name")) {
      processor = line.substr(std::min(line.find(':') + 2, line.size()));
      break;
    }
  return printable(fmt::format("{}: {}, {} threads", host, processor, std::thread::hardware_concurrency()));
}

}  // namespace gnomon
