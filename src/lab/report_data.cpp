#include "lab/report_data.h"

#include "base/error.h"
#include "base/file.h"
#include "lab/results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kNewestSchema = kResultsVersion;
constexpr int kMaxSide = 16384;  // of a picture, pixels

// A value and where it stands in the file, for messages: "rows[3].bias".
class Field {
 public:
  Field(const Json& json, const std::string& file, std::string where)
      : json_(json), file_(file), where_(std::move(where)) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw fileError(file_, fmt::format("{} {}", where_.empty() ? "its value" : where_, what),
                    "write it anew with gnomon compare -o");
  }

  bool has(const char* key) const {
    return json_.is_object() && json_.contains(key) && !json_.at(key).is_null();
  }
  Field operator[](const char* key) const {
    const std::string path = where_.empty() ? key : where_ + "." + key;
    if (!json_.is_object()) fail("must be an object");
    const auto found = json_.find(key);
    if (found == json_.end()) Field(json_, file_, path).fail("is missing");
    return {*found, file_, path};
  }

  std::string text() const {
    if (!json_.is_string()) fail("must be a text");
    return json_.get<std::string>();
  }
  double number() const {
    if (!json_.is_number() || !std::isfinite(json_.get<double>())) fail("must be a number");
    return json_.get<double>();
  }
  uint64_t count() const {
    if (!json_.is_number_unsigned()) fail("must be a whole number, not negative");
    return json_.get<uint64_t>();
  }
  int pixels() const {
    if (count() > kMaxSide) fail(fmt::format("must be at most {}", kMaxSide));
    return static_cast<int>(count());
  }
  bool flag() const {
    if (!json_.is_boolean()) fail("must be true or false");
    return json_.get<bool>();
  }

  template <typename Visit>
  void forItems(const Visit& visit) const {
    if (!json_.is_array()) fail("must be a list");
    for (size_t i = 0; i < json_.size(); ++i) visit(Field(json_[i], file_, fmt::format("{}[{}]", where_, i)));
  }
  template <typename Visit>
  void forMembers(const Visit& visit) const {
    if (!json_.is_object()) fail("must be an object");
    for (const auto& [key, value] : json_.items()) visit(key, Field(value, file_, where_ + "." + key));
  }

  // Any scalar, as a person writes it.
  std::string anyText() const {
    if (json_.is_string()) return json_.get<std::string>();
    if (json_.is_number_float()) return fmt::format("{}", json_.get<double>());
    return json_.dump();
  }
  bool isNumber() const { return json_.is_number(); }
  bool isArray() const { return json_.is_array(); }

 private:
  const Json& json_;
  const std::string& file_;
  std::string where_;
};

std::vector<double> readNumbers(const Field& field) {
  std::vector<double> numbers;
  field.forItems([&](const Field& item) { numbers.push_back(item.number()); });
  return numbers;
}

std::string vectorText(const std::vector<double>& v) {
  std::string text;
  for (const double x : v) text += fmt::format("{}{:.4g}", text.empty() ? "" : ", ", x);
  return text;
}

// Schema 1 listed paths only; their kind is in the name: "spot/dual.labels.png".
std::string kindOfPath(const std::string& path) {
  const fs::path file(path);
  if (file.extension() == ".exr") return "data";
  const std::string kind = file.stem().extension().string();
  return kind.empty() ? "picture" : kind.substr(1);
}

ReportPictures readPictures(const Field& field) {
  ReportPictures pictures;
  if (field.isArray())
    field.forItems([&](const Field& item) { pictures.emplace_back(kindOfPath(item.text()), item.text()); });
  else
    field.forMembers(
        [&](const std::string& kind, const Field& path) { pictures.emplace_back(kind, path.text()); });
  return pictures;
}

std::optional<ReportPlace> readPlace(const Field& row, const char* key) {
  if (!row.has(key)) return std::nullopt;
  const Field place = row[key];
  const ReportPlace read{.x = place["x"].pixels(),
                         .y = place["y"].pixels(),
                         .size = place["size"].pixels(),
                         .pixels = place["pixels"].count()};
  if (read.size == 0) place["size"].fail("must be at least 1");
  return read;
}

std::optional<ReportElsewhere> readElsewhere(const Field& tuning, const char* key) {
  if (!tuning.has(key)) return std::nullopt;
  const Field field = tuning[key];
  return ReportElsewhere{.where = field.has("camera")
                                      ? fmt::format("camera {}", field["camera"].text())
                                      : fmt::format("map of {0} × {0} texels", field["map_size"].count()),
                         .biasError = field["bias_error"].number(),
                         .bestBiasError = field["best_bias_error"].number(),
                         .bestValue = field["best_value"].number()};
}

std::optional<ReportTuning> readTuning(const Field& row) {
  if (!row.has("tuning")) return std::nullopt;
  const Field tuning = row["tuning"];
  return ReportTuning{.knob = tuning["knob"].text(),
                      .unit = tuning.has("unit") ? tuning["unit"].text() : "",
                      .value = tuning["value"].number(),
                      .evaluations = tuning["evaluations"].count(),
                      .otherCamera = readElsewhere(tuning, "other_camera"),
                      .otherMapSize = readElsewhere(tuning, "other_map_size")};
}

std::optional<double> readOptionalNumber(const Field& field, const char* key) {
  if (!field.has(key)) return std::nullopt;
  return field[key].number();
}

ReportRow readRow(const Field& field) {
  ReportRow row{.map = field["map"].text(),
                .bias = field["bias"].text(),
                .filter = field.has("filter") ? field["filter"].text() : "none",
                .mapName = field["map"].text(),
                .light = field.has("light") ? field["light"].text() : "",
                .isSum = field.has("sum") && field["sum"].flag(),
                .mapSize = field["map_size"].count(),
                .layers = field["layers"].count(),
                .scored = field["scored"].count(),
                .agree = field["agree"].count(),
                .acne = field["acne"].count(),
                .leak = field["leak"].count(),
                .edgeShadow = field["edge_shadow"].count(),
                .edgeLight = field["edge_light"].count(),
                .uncovered = field["uncovered"].count(),
                .biasError = field["bias_error"].number(),
                .buildMs = field["build_ms"].number(),
                .shadeMs = field["shade_ms"].number(),
                .frameMs = field["frame_ms"].number(),
                .rmse = readOptionalNumber(field, "rmse"),
                .flip = readOptionalNumber(field, "flip"),
                .tuned = field.has("tuned") && field["tuned"].flag(),
                .tuning = readTuning(field),
                .worstAcne = readPlace(field, "worst_acne"),
                .worstLeak = readPlace(field, "worst_leak")};
  if (row.agree > row.scored) field["agree"].fail("must be at most scored");
  if (field.has("params"))
    field["params"].forMembers([&](const std::string& name, const Field& value) {
      row.params.push_back({name, value.anyText(), value.isNumber() && name != "cascades"});
    });
  if (field.has("pictures")) row.pictures = readPictures(field["pictures"]);
  return row;
}

ReportMap readMap(const Field& field) {
  ReportMap map{.map = field["map"].text(),
                .light = field.has("light") ? field["light"].text() : "",
                .mapSize = field.has("map_size") ? field["map_size"].count() : 0,
                .layers = field.has("layers") ? field["layers"].count() : 0,
                .zNear = readOptionalNumber(field, "z_near"),
                .zFar = readOptionalNumber(field, "z_far")};
  if (field.has("pictures")) map.pictures = readPictures(field["pictures"]);
  if (field.has("truth_filtered"))
    field["truth_filtered"].forMembers([&](const std::string& filter, const Field& pictures) {
      map.filteredTruths.emplace_back(filter, readPictures(pictures));
    });
  return map;
}

std::string lightText(const Field& light) {
  std::string text = light["name"].text();
  if (text.empty()) text = "unnamed";
  text += fmt::format(" ({})", light["type"].text());
  if (light.has("position")) text += fmt::format(" at {} m", vectorText(readNumbers(light["position"])));
  if (light.has("direction")) text += fmt::format(" towards {}", vectorText(readNumbers(light["direction"])));
  if (light.has("cone_degrees")) text += fmt::format(", cone {:.4g}°", light["cone_degrees"].number());
  return text;
}

ReportTruth readTruth(const Field& field) {
  return {.map = field["map"].text(),
          .light = lightText(field["light"]),
          .lightName = field["light"]["name"].text(),
          .scored = field["scored"].count(),
          .lit = field["lit"].count(),
          .facingAway = field["facing_away"].count(),
          .outsideCone = field["outside_cone"].count(),
          .flipsHalf = field["margin_flips_half"].count(),
          .flipsDouble = field["margin_flips_double"].count(),
          .margin = field["margin"].number()};
}

// Schema 1 did not list the pictures of a map: they stood beside its rows' under fixed names.
ReportMap mapOfSchema1(const Field& truth, const fs::path& folder, const std::vector<ReportRow>& rows) {
  ReportMap map{.map = truth["map"].text(),
                .zNear = readOptionalNumber(truth, "z_near"),
                .zFar = readOptionalNumber(truth, "z_far")};
  const auto row = std::ranges::find(rows, map.map, &ReportRow::map);
  if (row != rows.end()) {
    map.mapSize = row->mapSize;
    map.layers = row->layers;
  }
  const std::pair<const char*, const char*> names[] = {
      {"depth", "depth.png"}, {"truth", "truth.png"}, {"truth_beauty", "truth.beauty.png"}};
  for (const auto& [kind, name] : names)
    if (fs::exists(folder / map.map / name)) map.pictures.emplace_back(kind, map.map + "/" + name);
  return map;
}

// Where several lights were compared, a map is named with its light; where there was one, its name says
// nothing.
void nameLights(ReportData& data) {
  const bool several = std::ranges::any_of(data.rows, &ReportRow::isSum);
  const auto name = [&](std::string& map, const std::string& light) {
    if (several) map += ", " + light;
  };
  for (ReportTruth& truth : data.truths) name(truth.map, truth.lightName);
  for (ReportMap& map : data.maps) name(map.map, map.light);
  for (ReportRow& row : data.rows) {
    name(row.map, row.light);
    if (!several) row.light.clear();
  }
}

ReportData readAll(const Field& root, const fs::path& folder) {
  const uint64_t schema = root["schema"].count();
  if (schema < 1 || schema > kNewestSchema)
    throw fileError((folder / "results.json").string(), fmt::format("has schema {}", schema),
                    fmt::format("this gnomon reads 1 to {}", kNewestSchema));
  const Field program = root["gnomon"];
  const Field scene = root["scene"];
  const Field camera = root["camera"];
  ReportData data{.version = program["version"].text(),
                  .device = program["device"].text(),
                  .driver = program["driver"].text(),
                  .command = program.has("command") ? program["command"].text() : "",
                  .sceneName = scene["name"].text(),
                  .sceneSource = scene.has("source") ? scene["source"].text() : "",
                  .triangles = scene["triangles"].count(),
                  .sceneScale = scene["sceneScale"].number(),
                  .cameraName = camera["name"].text(),
                  .cameraEye = readNumbers(camera["eye"]),
                  .fovDegrees = camera["fov_degrees"].number(),
                  .width = camera["width"].pixels(),
                  .height = camera["height"].pixels(),
                  .gbufferMs = root["gbuffer_ms"].number()};
  if (data.width == 0 || data.height == 0) camera.fail("must have a width and a height");
  root["truths"].forItems([&](const Field& truth) { data.truths.push_back(readTruth(truth)); });
  root["rows"].forItems([&](const Field& row) { data.rows.push_back(readRow(row)); });
  if (root.has("maps"))
    root["maps"].forItems([&](const Field& map) { data.maps.push_back(readMap(map)); });
  else
    root["truths"].forItems(
        [&](const Field& truth) { data.maps.push_back(mapOfSchema1(truth, folder, data.rows)); });
  nameLights(data);
  std::ranges::stable_sort(data.rows, {},
                           [](const ReportRow& row) { return std::tuple(row.biasError, row.wrong()); });
  return data;
}

}  // namespace

ReportData readReportData(const fs::path& folder) {
  const fs::path path = folder / "results.json";
  if (!fs::exists(path))
    throw fileError(path.string(), "does not exist", "name a folder that gnomon compare -o wrote");
  Json json;
  try {
    json = Json::parse(readFile(path));
  } catch (const Json::exception& error) {
    throw fileError(path.string(), "is not JSON", error.what());
  }
  return readAll(Field(json, path.string(), ""), folder);
}

}  // namespace gnomon
