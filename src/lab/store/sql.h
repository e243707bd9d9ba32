#pragma once
// SQLite (https://sqlite.org/cinterface.html) as objects that close themselves. A failure is a WorldError that names
// the file and the remedy.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

struct sqlite3;
struct sqlite3_stmt;

namespace gnomon::sql {

class Database;

// A prepared statement. Columns and parameters count from 0.
class Statement {
 public:
  // Binds all parameters, in order, and begins anew: numbers, texts, std::optional of them (NULL where absent).
  template <typename... Values>
  Statement& with(const Values&... values) & {
    reset();
    int at = 0;
    (bind(at++, values), ...);
    return *this;
  }
  template <typename... Values>
  Statement with(const Values&... values) && {
    with(values...);
    return std::move(*this);
  }
  bool step();  // to the next row; false after the last
  void run() {
    while (step()) {
    }
  }  // to the end

  bool isNull(int column) const;
  int64_t integer(int column) const;
  double number(int column) const;
  std::string text(int column) const;  // of a blob its bytes
  std::optional<int64_t> maybeInteger(int column) const;
  std::optional<double> maybeNumber(int column) const;
  int columnCount() const;
  std::string columnName(int column) const;

  void bind(int at, int64_t value);
  void bind(int at, int value) { bind(at, int64_t{value}); }
  void bind(int at, bool value) { bind(at, int64_t{value}); }
  void bind(int at, uint64_t value) { bind(at, static_cast<int64_t>(value)); }
  void bind(int at, double value);
  void bind(int at, std::string_view value);
  void bind(int at, const std::string& value) { bind(at, std::string_view(value)); }
  void bind(int at, const char* value) { bind(at, std::string_view(value)); }
  void bindBlob(int at, std::string_view bytes);
  template <typename T>
  void bind(int at, const std::optional<T>& value) {
    if (value)
      bind(at, *value);
    else
      bindNull(at);
  }
  void bindNull(int at);
  void reset();

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  Statement(const Database& database, std::string_view sql);
  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

// ReadOnly: nothing in it is changed; what a run that was killed left in its journal is taken in, and the journal goes.
enum class Open { ReadOnly, Existing, Create };

class Database {
 public:
  Database(const std::filesystem::path& path, Open how);
  // How long it waits for another program that holds a lock; at first 10 s.
  void setPatience(int ms);
  const std::filesystem::path& path() const { return path_; }

  void execute(const std::string& statements);
  // PRAGMA journal_mode=WAL, for which SQLite itself does not wait.
  void useWriteAheadLog();
  Statement prepare(std::string_view sql) const { return {*this, sql}; }
  int64_t lastRowId() const;
  // Of the whole statement's first row; nothing where there is none.
  std::optional<std::string> textOf(std::string_view sql) const;
  int64_t integerOf(std::string_view sql) const;

  [[noreturn]] void fail(int code) const;

 private:
  friend class Statement;
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::filesystem::path path_;
  int patienceMs_ = 0;
  std::unique_ptr<sqlite3, Close> database_;
};

// Rolled back unless it is committed.
class Transaction {
 public:
  explicit Transaction(Database& database);  // takes the write lock at once
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool isDone_ = false;
};

}  // namespace gnomon::sql
