#include "lab/sweep/plan.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/parse_json.h"
#include "base/suggest.h"
#include "lab/results/json_schema_of.h"
#include "lab/sweep/json_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace gnomon {

namespace json_schema {

template <>
struct SchemaOf<PlanParameters> {
  static Json make() {
    Json either = Json::object();
    either["anyOf"].push_back(ofType("number"));
    either["anyOf"].push_back(arrayOf(ofType("number")));
    return objectOf(either);
  }
};

}  // namespace json_schema

namespace {

using PlanJson = nlohmann::ordered_json;

constexpr uint64_t kMostPlanBytes = uint64_t{16} << 20;
constexpr size_t kMostItems = 100000;  // of a list

class PlanReader {
 public:
  explicit PlanReader(Plan& plan) : plan_(plan) {}

  template <Record R>
  void read(const PlanJson& json, const std::string& where, R& record) {
    if constexpr (std::is_base_of_v<Placed, R>) record.where = where;
    if constexpr (requires { R::kShorthand; }) {
      if (!json.is_object()) {
        forEachField<R>([&](const auto& field) {
          if (std::string_view(field.name) != R::kShorthand) return;
          readField(json, where, field.notes, record.*field.get);
        });
        return;
      }
    }
    if (!json.is_object()) plan_.fail(where, "must be an object" + shown(json));
    std::vector<std::string> names;
    forEachField<R>([&](const auto& field) { names.emplace_back(field.name); });
    for (const auto& [key, value] : json.items())
      if (std::ranges::find(names, key) == names.end()) refuseKey(inside(where, key), key, names);
    forEachField<R>([&](const auto& field) {
      const auto found = json.find(field.name);
      if (found != json.end()) return readField(*found, inside(where, field.name), field.notes, record.*field.get);
      if (field.notes.absent == Absent::Refused)
        plan_.fail(where, fmt::format("lacks '{}': {}", field.name, field.notes.says));
    });
  }

 private:
  static std::string inside(const std::string& where, const std::string& key) {
    return where.empty() ? key : where + "." + key;
  }

  static std::string shown(const PlanJson& json) {
    return fmt::format(", and is {}", oneLine(json.dump(-1, ' ', false, PlanJson::error_handler_t::replace), 40));
  }

  [[noreturn]] void refuseKey(const std::string& where, const std::string& key, const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    plan_.fail(where, "is no field here; " + chooseFrom(key, list));
  }

  template <typename T>
  void readField(const PlanJson& json, const std::string& where, const FieldNotes& notes, T& value) {
    readValue(json, where, value);
    if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) checkRange(where, notes, value);
    if constexpr (std::is_same_v<T, std::vector<int>>)
      for (size_t i = 0; i < value.size(); ++i) checkRange(fmt::format("{}[{}]", where, i), notes, value[i]);
  }

  template <typename T>
  void checkRange(const std::string& where, const FieldNotes& notes, T value) {
    const auto number = static_cast<double>(value);
    if (number >= notes.least && number <= notes.most) return;
    if (notes.most >= 1e300) plan_.fail(where, fmt::format("is {}, and must be at least {:g}", value, notes.least));
    plan_.fail(where,
               fmt::format("is {}, outside {:g}..{:g}", value, notes.least > -1e300 ? notes.least : 0.0, notes.most));
  }

  void readValue(const PlanJson& json, const std::string& where, std::string& value) {
    if (!json.is_string()) plan_.fail(where, "must be a text in quotes" + shown(json));
    value = json.get<std::string>();
    if (value.empty()) plan_.fail(where, "is empty");
    if (value.find('\0') != std::string::npos) plan_.fail(where, "has a zero byte in it");
  }
  void readValue(const PlanJson& json, const std::string& where, bool& value) {
    if (!json.is_boolean()) plan_.fail(where, "must be true or false" + shown(json));
    value = json.get<bool>();
  }
  void readValue(const PlanJson& json, const std::string& where, int& value) {
    if (!json.is_number_integer() || json.get<double>() < 0.0 || json.get<double>() > std::numeric_limits<int>::max())
      plan_.fail(where, fmt::format("must be a whole number, 0 to {}{}", std::numeric_limits<int>::max(), shown(json)));
    value = json.get<int>();
  }
  void readValue(const PlanJson& json, const std::string& where, double& value) {
    if (!json.is_number() || !std::isfinite(json.get<double>())) plan_.fail(where, "must be a number" + shown(json));
    value = json.get<double>();
  }
  template <Record R>
  void readValue(const PlanJson& json, const std::string& where, R& value) {
    read(json, where, value);
  }
  template <typename T>
  void readValue(const PlanJson& json, const std::string& where, std::vector<T>& values) {
    if (!json.is_array()) plan_.fail(where, "must be a list in brackets" + shown(json));
    if (json.size() > kMostItems) plan_.fail(where, fmt::format("has {} items; at most {}", json.size(), kMostItems));
    values.clear();
    for (size_t i = 0; i < json.size(); ++i) readValue(json[i], fmt::format("{}[{}]", where, i), values.emplace_back());
  }
  void readValue(const PlanJson& json, const std::string& where, NamedTexts& texts) {
    if (!json.is_object()) plan_.fail(where, "must be an object" + shown(json));
    for (const auto& [key, value] : json.items()) {
      const std::string inner = inside(where, key);
      if (value.is_number() || value.is_boolean())
        texts.emplace_back(key, value.dump());
      else
        readValue(value, inner, texts.emplace_back(key, "").second);
    }
  }
  void readValue(const PlanJson& json, const std::string& where, PlanParameters& parameters) {
    if (!json.is_object()) plan_.fail(where, "must be an object" + shown(json));
    for (const auto& [key, value] : json.items()) {
      std::vector<double>& values = parameters.emplace_back(key, std::vector<double>()).second;
      if (value.is_array())
        readValue(value, inside(where, key), values);
      else
        readValue(value, inside(where, key), values.emplace_back());
      if (values.empty()) plan_.fail(inside(where, key), "is empty; give a number, or a list of numbers");
    }
  }

  Plan& plan_;
};

}  // namespace

void Plan::fail(const std::string& where, const std::string& what) const {
  // Of what stands nowhere in the file, as a field that is missing, the place of what it should stand in.
  std::string near = where;
  auto found = std::ranges::find(offsets, near, [](const auto& entry) { return entry.first; });
  while (found == offsets.end() && !near.empty()) {
    near.resize(std::min(near.find_last_of(".["), near.size()) == near.size() ? 0 : near.find_last_of(".["));
    found = std::ranges::find(offsets, near, [](const auto& entry) { return entry.first; });
  }
  const LineAndColumn place = lineAndColumn(text, found == offsets.end() ? 0 : found->second);
  throw WorldError(fmt::format("{}:{}:{}: {} {}", printable(path.string()), place.line, place.column,
                               where.empty() ? "the plan" : printable(where), what));
}

Plan parsePlan(const std::filesystem::path& path, const std::string& text) {
  constexpr size_t kMostMembers = 4096;
  Plan plan;
  plan.path = path;
  plan.folder = path.parent_path();
  plan.text = text;
  PlanJson json;
  try {
    json = parseJson<PlanJson>(text, {.depth = 16, .members = kMostMembers, .comments = true});
  } catch (const PlanJson::parse_error& error) {
    const LineAndColumn place = lineAndColumn(text, error.byte > 0 ? error.byte - 1 : 0);
    std::string what = error.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    const size_t column = what.find("column ");
    if (column != std::string::npos && what.find(": ", column) != std::string::npos)
      what = what.substr(what.find(": ", column) + 2);
    throw WorldError(fmt::format("{}:{}:{}: is not JSON: {}", printable(path.string()), place.line, place.column,
                                 oneLine(what, 160)));
  } catch (const std::exception& error) {
    throw WorldError(fmt::format("{}:1:1: is not JSON: {}", printable(path.string()), oneLine(error.what(), 160)));
  }
  const JsonPlaces places = placesInJson(text);
  plan.offsets = places.offsets;
  if (!places.twice.empty()) plan.fail(places.twice, "stands here twice; leave one of them out");
  PlanReader(plan).read(json, "", plan);
  return plan;
}

Plan readPlan(const std::filesystem::path& path) {
  return parsePlan(path, readRegularFile(path, kMostPlanBytes));
}

std::string planJsonSchema() {
  json_schema::Json schema = json_schema::Json::object();
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "Plan of gnomon sweep";
  schema["description"] = "docs/sweep.md explains it. Comments are allowed in the file.";
  schema.update(json_schema::schemaOf<Plan>());
  return schema.dump(1) + "\n";
}

}  // namespace gnomon
