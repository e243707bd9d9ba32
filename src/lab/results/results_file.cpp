#include "lab/results/results_file.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/parse_json.h"
#include "lab/results/json_field.h"

#include <algorithm>
#include <array>
#include <limits>

namespace gnomon {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

// Writing.

Json toJson(bool value) {
  return value;
}
Json toJson(int value) {
  return value;
}
Json toJson(size_t value) {
  return value;
}
Json toJson(double value) {
  return value;
}
Json toJson(float value) {
  return shortest(value);
}
Json toJson(const std::string& value) {
  return value;
}
Json toJson(const glm::vec3& v) {
  return Json::array({shortest(v.x), shortest(v.y), shortest(v.z)});
}
Json toJson(Bound bound) {
  return boundName(bound);
}
Json toJson(ErrorMeasure measure) {
  return errorMeasureName(measure);
}
Json toJson(const NamedTexts& texts) {
  Json json = Json::object();
  for (const auto& [name, text] : texts) json[name] = text;
  return json;
}
Json toJson(const std::vector<std::pair<std::string, Pictures>>& named) {
  Json json = Json::object();
  for (const auto& [name, pictures] : named) json[name] = toJson(pictures);
  return json;
}
Json toJson(const Params& params) {
  Json json = Json::object();
  for (const Param& param : params) std::visit([&](const auto& value) { json[param.name] = value; }, param.value);
  return json;
}

template <typename T>
Json toJson(const std::vector<T>& items);

template <Record R>
Json toJson(const R& record) {
  Json json = Json::object();
  forEachField<R>([&](const auto& field) {
    if (!field.notes.inFile) return;
    const auto& value = std::invoke(field.get, record);
    if constexpr (kIsOptional<std::remove_cvref_t<decltype(value)>>) {
      if (value)
        json[field.name] = toJson(*value);
      else if (field.notes.absent != Absent::LeftOut)
        json[field.name] = nullptr;
    } else {
      json[field.name] = toJson(value);
    }
  });
  return json;
}

template <typename T>
Json toJson(const std::vector<T>& items) {
  Json json = Json::array();
  for (const T& item : items) json.push_back(toJson(item));
  return json;
}

// Names of files need not be UTF-8: what is not becomes U+FFFD.
std::string dumped(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// Reading.

void read(const JsonField& json, bool& value) {
  value = json.flag();
}
void read(const JsonField& json, size_t& value) {
  value = json.count();
}
void read(const JsonField& json, int& value) {
  const uint64_t count = json.count();
  constexpr int kMost = std::numeric_limits<int>::max();
  if (count > kMost) json.fail(fmt::format("must be at most {}", kMost));
  value = static_cast<int>(count);
}
void read(const JsonField& json, double& value) {
  value = json.number();
}
void read(const JsonField& json, float& value) {
  value = static_cast<float>(json.number());
}
void read(const JsonField& json, std::string& value) {
  value = json.text();
}
void read(const JsonField& json, glm::vec3& v) {
  const std::vector<double> values = json.numbers();
  if (values.size() != 3) json.fail("must be a list of three numbers");
  v = glm::vec3(values[0], values[1], values[2]);
}
void read(const JsonField& json, Bound& bound) {
  const std::string text = json.text();
  for (const Bound each : {Bound::Exact, Bound::AtLeast, Bound::AtMost})
    if (text == boundName(bound = each)) return;
  json.fail("must be exact, at_least or at_most");
}
void read(const JsonField& json, ErrorMeasure& measure) {
  const std::string text = json.text();
  for (const ErrorMeasure each : {ErrorMeasure::RelRmse, ErrorMeasure::RelRmse99})
    if (text == errorMeasureName(measure = each)) return;
  json.fail("must be rel_rmse or rel_rmse_99");
}

// Schema 1 listed paths only; their kind is in the name: "spot/dual.labels.png".
std::string kindOfPath(const std::string& path) {
  const fs::path file(path);
  if (file.extension() == ".exr") return "data";
  const std::string kind = file.stem().extension().string();
  return kind.empty() ? "picture" : kind.substr(1);
}

void read(const JsonField& json, NamedTexts& texts) {
  if (json.isArray())
    json.forItems([&](const JsonField& item) { texts.emplace_back(kindOfPath(item.text()), item.text()); });
  else
    json.forMembers([&](const std::string& name, const JsonField& text) { texts.emplace_back(name, text.text()); });
}
void read(const JsonField& json, std::vector<std::pair<std::string, Pictures>>& named) {
  json.forMembers([&](const std::string& name, const JsonField& pictures) {
    named.emplace_back(name, Pictures());
    read(pictures, named.back().second);
  });
}
void read(const JsonField& json, Params& params) {
  json.forMembers([&](const std::string& name, const JsonField& value) { params.push_back({name, value.scalar()}); });
}

template <typename T>
void read(const JsonField& json, std::vector<T>& items);

void checkRecord(const JsonField&, const auto&) {}
void checkRecord(const JsonField& json, const Row& row) {
  if (row.agree > row.scored) json["agree"].fail("must be at most scored");
}
void checkRecord(const JsonField& json, const CameraFacts& camera) {
  if (camera.width == 0 || camera.height == 0) json.fail("must have a width and a height");
}

template <typename T>
void checkRange(const JsonField& json, const FieldNotes& notes, const T& value) {
  if constexpr (std::is_arithmetic_v<T>) {
    const double number = static_cast<double>(value);
    if (number < notes.least)
      json.fail(notes.least == 0.0 ? "must not be negative" : fmt::format("must be at least {}", notes.least));
    if (number > notes.most) json.fail(fmt::format("must be at most {}", notes.most));
  }
}

template <Record R>
void read(const JsonField& json, R& record) {
  forEachField<R>([&](const auto& field) {
    if constexpr (std::remove_cvref_t<decltype(field)>::isMember) {
      auto& value = record.*field.get;
      constexpr bool optional = kIsOptional<std::remove_reference_t<decltype(value)>>;
      if ((optional || field.notes.absent == Absent::Earlier) && !json.has(field.name)) return;
      const JsonField member = json[field.name];
      if constexpr (optional) {
        read(member, value.emplace());
        checkRange(member, field.notes, *value);
      } else {
        read(member, value);
        checkRange(member, field.notes, value);
      }
    }
  });
  checkRecord(json, record);
}

template <typename T>
void read(const JsonField& json, std::vector<T>& items) {
  json.forItems([&](const JsonField& item) { read(item, items.emplace_back()); });
}

// Schema 1 did not list the pictures of a map: they stood beside its rows' under fixed names.
MapSummary mapOfSchema1(const TruthSummary& truth, const fs::path& folder, const std::vector<Row>& rows) {
  MapSummary map{.map = truth.map, .zNear = truth.zNear, .zFar = truth.zFar};
  const auto row = std::ranges::find(rows, map.map, &Row::map);
  if (row != rows.end()) {
    map.width = map.height = row->mapSide;
    map.layers = row->layers;
  }
  const std::pair<const char*, const char*> names[] = {
      {"depth", "depth.png"}, {"truth", "truth.png"}, {"truth_beauty", "truth.beauty.png"}};
  for (const auto& [kind, name] : names)
    if (fs::exists(folder / map.map / name)) map.pictures.emplace_back(kind, map.map + "/" + name);
  return map;
}

// What files of earlier schemas lack.
void complete(const JsonField& root, const fs::path& folder, Comparison& comparison) {
  if (comparison.schema >= 4) return;
  for (Row& row : comparison.rows) {
    if (row.mapDimensions.empty()) row.mapDimensions = fmt::format("{}", row.mapSide);
    if (row.tuning && row.units.empty()) row.units = {{row.tuning->knob, row.tuning->unit}};
  }
  if (root.has("maps")) return;
  for (const TruthSummary& truth : comparison.truths)
    comparison.maps.push_back(mapOfSchema1(truth, folder, comparison.rows));
}

void complete(MediaResults& media) {
  if (media.schema >= 4) return;
  for (MediaRow& row : media.rows) row.isBaseline = row.integrator == "march";
}

Results readAll(const JsonField& root, const fs::path& folder) {
  const uint64_t schema = root["schema"].count();
  if (schema < 1 || schema > kResultsVersion)
    throw fileError((folder / "results.json").string(), fmt::format("has schema {}", schema),
                    fmt::format("this gnomon reads 1 to {}", kResultsVersion));
  if (root.has("media") && !root["media"].isEmpty()) {
    MediaResults media;
    read(root, media);
    complete(media);
    return media;
  }
  Comparison comparison;
  read(root, comparison);
  complete(root, folder, comparison);
  return comparison;
}

}  // namespace

std::string resultsText(const Comparison& comparison) {
  return dumped(toJson(comparison));
}

std::string resultsText(const MediaResults& media) {
  return dumped(toJson(media));
}

Results readResults(const fs::path& folder) {
  constexpr size_t kMostMembers = 4096;  // a row has fewer than a hundred
  const fs::path path = folder / "results.json";
  if (!fs::exists(path))
    throw fileError(path.string(), "does not exist", "name a folder that gnomon compare -o or gnomon fog -o wrote");
  const std::string text = readRegularFile(path, kMostResultsBytes);
  Json json;
  try {
    json = parseJson<Json>(text, {.members = kMostMembers});
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw fileError(path.string(), "is not JSON", oneLine(error.what(), 160));
  }
  return readAll(JsonField(json, path.string(), ""), folder);
}

}  // namespace gnomon
