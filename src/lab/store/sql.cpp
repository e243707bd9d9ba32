#include "lab/store/sql.h"

#include "base/error.h"
#include "base/message.h"

#include <sqlite3.h>

#include <chrono>
#include <thread>

#include <fmt/format.h>

namespace gnomon::sql {

namespace {

constexpr int kPatienceMs = 10000;

const char* remedyFor(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return "make room and run the same command again: what was done is kept";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program holds it; close that and run the same command again: what was done is kept";
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
    case SQLITE_AUTH:
      return "check the path and its permissions";
    case SQLITE_NOTADB:
      return "name a file that gnomon sweep wrote";
    case SQLITE_CORRUPT:
      return "save what is left with: sqlite3 FILE .recover";
    case SQLITE_IOERR:
      return "check the disk; what was done before is kept";
    case SQLITE_NOMEM:
      return "free memory and run the same command again";
    default:
      return "if gnomon sweep wrote it, it is damaged or of another version";
  }
}

}  // namespace

void Database::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Database::Database(const std::filesystem::path& path, Open how) : path_(path) {
  // Who may only read leaves a journal (-wal, -shm) that he had to make; who may write, and does not, takes it away.
  const int flags = SQLITE_OPEN_READWRITE | (how == Open::Create ? SQLITE_OPEN_CREATE : 0);
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &database, flags, nullptr);
  database_.reset(database);
  if (code != SQLITE_OK) fail(code);
  sqlite3_extended_result_codes(database, 1);
  setPatience(kPatienceMs);
  if (how == Open::ReadOnly) execute("PRAGMA query_only=1");
}

void Database::setPatience(int ms) {
  patienceMs_ = ms;
  sqlite3_busy_timeout(database_.get(), ms);
}

void Database::fail(int code) const {
  const char* why = database_ ? sqlite3_errmsg(database_.get()) : sqlite3_errstr(code);
  throw fileError(path_.string(), oneLine(why, 160), remedyFor(code));
}

void Database::execute(const std::string& statements) {
  const int code = sqlite3_exec(database_.get(), statements.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

void Database::useWriteAheadLog() {
  const auto begun = std::chrono::steady_clock::now();
  for (;;) {
    const int code = sqlite3_exec(database_.get(), "PRAGMA journal_mode=WAL", nullptr, nullptr, nullptr);
    if (code == SQLITE_OK) return;
    const bool isPatient = std::chrono::steady_clock::now() - begun < std::chrono::milliseconds(patienceMs_);
    if ((code & 0xff) != SQLITE_BUSY || !isPatient) fail(code);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int64_t Database::lastRowId() const {
  return sqlite3_last_insert_rowid(database_.get());
}

std::optional<std::string> Database::textOf(std::string_view sql) const {
  Statement statement = prepare(sql);
  return statement.step() ? std::optional(statement.text(0)) : std::nullopt;
}

int64_t Database::integerOf(std::string_view sql) const {
  Statement statement = prepare(sql);
  return statement.step() ? statement.integer(0) : 0;
}

Statement::Statement(const Database& database, std::string_view sql) : database_(&database) {
  sqlite3_stmt* statement = nullptr;
  const int code =
      sqlite3_prepare_v2(database.database_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  statement_.reset(statement);
  if (code != SQLITE_OK) database.fail(code);
}

void Statement::reset() {
  sqlite3_reset(statement_.get());  // tells again what step told
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    try {
      database_->fail(code);
    } catch (...) {
      sqlite3_reset(statement_.get());  // else it holds its lock
      throw;
    }
  }
  sqlite3_reset(statement_.get());
  return false;
}

bool Statement::isNull(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::number(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

std::string Statement::text(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const auto size = static_cast<size_t>(sqlite3_column_bytes(statement_.get(), column));
  return bytes == nullptr ? std::string() : std::string(static_cast<const char*>(bytes), size);
}

std::optional<int64_t> Statement::maybeInteger(int column) const {
  return isNull(column) ? std::nullopt : std::optional(integer(column));
}

std::optional<double> Statement::maybeNumber(int column) const {
  return isNull(column) ? std::nullopt : std::optional(number(column));
}

int Statement::columnCount() const {
  return sqlite3_column_count(statement_.get());
}

std::string Statement::columnName(int column) const {
  return sqlite3_column_name(statement_.get(), column);
}

void Statement::bind(int at, int64_t value) {
  if (const int code = sqlite3_bind_int64(statement_.get(), at + 1, value); code != SQLITE_OK) database_->fail(code);
}

void Statement::bind(int at, double value) {
  if (const int code = sqlite3_bind_double(statement_.get(), at + 1, value); code != SQLITE_OK) database_->fail(code);
}

void Statement::bind(int at, std::string_view value) {
  const int code =
      sqlite3_bind_text64(statement_.get(), at + 1, value.data(), value.size(), SQLITE_TRANSIENT,  // NOLINT
                          SQLITE_UTF8);
  if (code != SQLITE_OK) database_->fail(code);
}

void Statement::bindBlob(int at, std::string_view bytes) {
  const int code =
      sqlite3_bind_blob64(statement_.get(), at + 1, bytes.data(), bytes.size(), SQLITE_TRANSIENT);  // NOLINT
  if (code != SQLITE_OK) database_->fail(code);
}

void Statement::bindNull(int at) {
  if (const int code = sqlite3_bind_null(statement_.get(), at + 1); code != SQLITE_OK) database_->fail(code);
}

Transaction::Transaction(Database& database) : database_(database) {
  database_.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (isDone_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (const WorldError&) {  // it was rolled back by what went wrong
  }
}

void Transaction::commit() {
  database_.execute("COMMIT");
  isDone_ = true;
}

}  // namespace gnomon::sql
