#include "lab/statistics/measured_cases.h"

#include "base/error.h"
#include "base/suggest.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr std::array<const char*, 3> kErrorNames = {"bias_error", "all_wrong", "rmse"};

// Names in the order in which they first come.
class Numbers {
 public:
  size_t of(const std::string& name) {
    const auto [entry, isNew] = numbers_.try_emplace(name, names_.size());
    if (isNew) names_.push_back(name);
    return entry->second;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::map<std::string, size_t> numbers_;
  std::vector<std::string> names_;
};

std::vector<std::string> textsOf(const sql::Database& database, const char* sql) {
  std::vector<std::string> texts;
  sql::Statement rows = database.prepare(sql);
  while (rows.step())
    if (!rows.isNull(0)) texts.push_back(rows.text(0));
  return texts;
}

void checkNames(const sql::Database& database, const char* flag, const char* column,
                const std::vector<std::string>& wanted) {
  if (wanted.empty()) return;
  const std::vector<std::string> known =
      textsOf(database, fmt::format("SELECT DISTINCT {} FROM results", column).c_str());
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  for (const std::string& name : wanted)
    if (std::ranges::find(known, name) == known.end())
      throw UsageError(fmt::format("{} {}: the store has no such; {}", flag, name, chooseFrom(name, list)));
}

template <typename T>
bool fits(const std::vector<T>& wanted, const T& value) {
  return wanted.empty() || std::ranges::find(wanted, value) != wanted.end();
}

}  // namespace

const char* errorName(ErrorBy by) {
  return kErrorNames[static_cast<size_t>(by)];
}

ErrorBy parseErrorBy(const std::string& name) {
  for (size_t i = 0; i < kErrorNames.size(); ++i)
    if (name == kErrorNames[i]) return static_cast<ErrorBy>(i);
  throw UsageError(fmt::format("--by {}: {}", name, chooseFrom(name, "bias_error, all_wrong, rmse")));
}

CaseTable measuredCases(const Store& store, const CaseFilter& filter) {
  const sql::Database& database = store.database();
  checkNames(database, "--scene", "scene", filter.scenes);
  checkNames(database, "--map", "map", filter.maps);
  CaseTable table;
  table.name = store.note("name").value_or("");
  const bool filtered = database.integerOf("SELECT count(*) FROM results WHERE filter <> 'none'") > 0;
  table.by = filter.by.value_or(filtered ? ErrorBy::Rmse : ErrorBy::BiasError);
  Numbers methods, scenes, maps, views;
  std::set<int> sizes;
  sql::Statement rows = database.prepare(
      "SELECT scene, light, camera, map || CASE map_options WHEN '' THEN '' ELSE ' ' || map_options END, map_size, "
      "method || CASE filter WHEN 'none' THEN '' ELSE ', ' || filter END, bias_error, all_wrong, rmse, map_texels, "
      "build_ms, shade_ms, frame_ms, key FROM results WHERE scored > 0 ORDER BY scene, camera, light, map, map_size, "
      "key");
  while (rows.step()) {
    const int size = static_cast<int>(rows.integer(4));
    const std::string map = rows.text(3);
    if (!fits(filter.scenes, rows.text(0)) || !fits(filter.maps, map.substr(0, map.find(' '))) ||
        !fits(filter.sizes, size))
      continue;
    sizes.insert(size);
    MeasuredCase one{.method = methods.of(rows.text(5)),
                     .scene = scenes.of(rows.text(0)),
                     .view = views.of(fmt::format("{}: {}, {}", rows.text(0), rows.text(2), rows.text(1))),
                     .map = maps.of(map),
                     .size = static_cast<size_t>(size),
                     .biasError = rows.number(6),
                     .allWrong = rows.number(7),
                     .texels = static_cast<size_t>(rows.integer(9)),
                     .buildMs = rows.maybeNumber(10),
                     .shadeMs = rows.maybeNumber(11),
                     .frameMs = rows.maybeNumber(12),
                     .key = rows.text(13)};
    one.error = table.by == ErrorBy::BiasError  ? one.biasError
                : table.by == ErrorBy::AllWrong ? one.allWrong
                                                : rows.number(8);
    table.cases.push_back(std::move(one));
  }
  const auto media = static_cast<size_t>(database.integerOf("SELECT count(*) FROM media_results"));
  if (table.cases.empty())
    throw fileError(database.path().string(),
                    media > 0 ? fmt::format("has no results of maps (of these), and {} of media", media)
                              : "has no results (of these)",
                    media > 0 ? "sqlite3 shows those of media: SELECT * FROM media_results"
                              : "run gnomon sweep first, or ask for others");
  table.sizes.assign(sizes.begin(), sizes.end());
  for (MeasuredCase& one : table.cases)
    one.size =
        static_cast<size_t>(std::ranges::lower_bound(table.sizes, static_cast<int>(one.size)) - table.sizes.begin());
  table.methods = methods.names();
  table.scenes = scenes.names();
  table.maps = maps.names();
  table.views = views.names();
  table.programs = textsOf(database, "SELECT DISTINCT program FROM results ORDER BY 1");
  table.devices = textsOf(database, "SELECT DISTINCT device || ', ' || driver FROM results ORDER BY 1");
  table.machines = textsOf(database, "SELECT DISTINCT machine FROM results ORDER BY 1");
  table.superseded = static_cast<size_t>(database.integerOf("SELECT count(*) FROM result WHERE superseded"));
  table.empty = static_cast<size_t>(database.integerOf("SELECT count(*) FROM tested WHERE empty IS NOT NULL"));
  table.failed = static_cast<size_t>(database.integerOf("SELECT count(*) FROM failure"));
  table.media = media;
  return table;
}

}  // namespace gnomon
