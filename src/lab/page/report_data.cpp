#include "lab/page/report_data.h"

#include "base/error.h"
#include "base/file.h"
#include "lab/page/media_data.h"
#include "lab/page/report_field.h"
#include "lab/results/schema.h"

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

std::optional<ReportPlace> readPlace(const ReportField& row, const char* key) {
  if (!row.has(key)) return std::nullopt;
  const ReportField place = row[key];
  const ReportPlace read{.x = place["x"].pixels(),
                         .y = place["y"].pixels(),
                         .size = place["size"].pixels(),
                         .pixels = place["pixels"].count()};
  if (read.size == 0) place["size"].fail("must be at least 1");
  return read;
}

std::optional<ReportElsewhere> readElsewhere(const ReportField& tuning, const char* key) {
  if (!tuning.has(key)) return std::nullopt;
  const ReportField field = tuning[key];
  return ReportElsewhere{.where = field.has("camera")
                                      ? fmt::format("camera {}", field["camera"].text())
                                      : fmt::format("map of {0} × {0} texels", field["map_size"].count()),
                         .biasError = field["bias_error"].number(),
                         .bestBiasError = field["best_bias_error"].number(),
                         .bestValue = field["best_value"].number()};
}

std::optional<ReportTuning> readTuning(const ReportField& row) {
  if (!row.has("tuning")) return std::nullopt;
  const ReportField tuning = row["tuning"];
  return ReportTuning{.knob = tuning["knob"].text(),
                      .unit = tuning.has("unit") ? tuning["unit"].text() : "",
                      .value = tuning["value"].number(),
                      .evaluations = tuning["evaluations"].count(),
                      .otherCamera = readElsewhere(tuning, "other_camera"),
                      .otherMapSize = readElsewhere(tuning, "other_map_size")};
}

ReportRow readRow(const ReportField& field) {
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
                .rmse = field.optionalNumber("rmse"),
                .flip = field.optionalNumber("flip"),
                .tuned = field.has("tuned") && field["tuned"].flag(),
                .tuning = readTuning(field),
                .worstAcne = readPlace(field, "worst_acne"),
                .worstLeak = readPlace(field, "worst_leak"),
                .command = field.has("command") ? field["command"].text() : ""};
  if (row.agree > row.scored) field["agree"].fail("must be at most scored");
  if (field.has("params"))
    field["params"].forMembers([&](const std::string& name, const ReportField& value) {
      const bool named = field.has("knob_units");  // since schema 4
      const bool isKnob = named ? field["knob_units"].has(name.c_str()) : value.isNumber() && name != "cascades";
      row.params.push_back({.name = name,
                            .text = value.anyText(),
                            .isKnob = isKnob,
                            .unit = named && isKnob ? field["knob_units"][name.c_str()].text() : ""});
    });
  if (field.has("pictures")) row.pictures = field["pictures"].pictures();
  return row;
}

ReportMap readMap(const ReportField& field) {
  ReportMap map{.map = field["map"].text(),
                .light = field.has("light") ? field["light"].text() : "",
                .mapSize = field.has("map_size") ? field["map_size"].count() : 0,
                .layers = field.has("layers") ? field["layers"].count() : 0,
                .zNear = field.optionalNumber("z_near"),
                .zFar = field.optionalNumber("z_far")};
  if (field.has("pictures")) map.pictures = field["pictures"].pictures();
  if (field.has("truth_filtered"))
    field["truth_filtered"].forMembers([&](const std::string& filter, const ReportField& pictures) {
      map.filteredTruths.emplace_back(filter, pictures.pictures());
    });
  return map;
}

ReportTruth readTruth(const ReportField& field) {
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
ReportMap mapOfSchema1(const ReportField& truth, const fs::path& folder, const std::vector<ReportRow>& rows) {
  ReportMap map{
      .map = truth["map"].text(), .zNear = truth.optionalNumber("z_near"), .zFar = truth.optionalNumber("z_far")};
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

ReportData readAll(const ReportField& root, const fs::path& folder) {
  const uint64_t schema = root["schema"].count();
  if (schema < 1 || schema > kNewestSchema)
    throw fileError((folder / "results.json").string(), fmt::format("has schema {}", schema),
                    fmt::format("this gnomon reads 1 to {}", kNewestSchema));
  const ReportField program = root["gnomon"];
  const ReportField scene = root["scene"];
  const ReportField camera = root["camera"];
  ReportData data{.version = program["version"].text(),
                  .device = program["device"].text(),
                  .driver = program["driver"].text(),
                  .command = program.has("command") ? program["command"].text() : "",
                  .sceneName = scene["name"].text(),
                  .sceneSource = scene.has("source") ? scene["source"].text() : "",
                  .triangles = scene["triangles"].count(),
                  .sceneScale = scene["sceneScale"].number(),
                  .cameraName = camera["name"].text(),
                  .cameraEye = camera["eye"].numbers(),
                  .fovDegrees = camera["fov_degrees"].number(),
                  .width = camera["width"].pixels(),
                  .height = camera["height"].pixels(),
                  .gbufferMs = root["gbuffer_ms"].number()};
  if (data.width == 0 || data.height == 0) camera.fail("must have a width and a height");
  root["truths"].forItems([&](const ReportField& truth) { data.truths.push_back(readTruth(truth)); });
  root["rows"].forItems([&](const ReportField& row) { data.rows.push_back(readRow(row)); });
  if (root.has("maps"))
    root["maps"].forItems([&](const ReportField& map) { data.maps.push_back(readMap(map)); });
  else
    root["truths"].forItems(
        [&](const ReportField& truth) { data.maps.push_back(mapOfSchema1(truth, folder, data.rows)); });
  nameLights(data);
  if (root.has("media") && !root["media"].isEmpty()) data.media = std::make_shared<MediaData>(readMediaData(root));
  std::ranges::stable_sort(data.rows, {}, [](const ReportRow& row) { return std::tuple(row.biasError, row.wrong()); });
  return data;
}

}  // namespace

ReportData readReportData(const fs::path& folder) {
  const fs::path path = folder / "results.json";
  if (!fs::exists(path)) throw fileError(path.string(), "does not exist", "name a folder that gnomon compare -o wrote");
  Json json;
  try {
    json = Json::parse(readFile(path));
  } catch (const Json::exception& error) {
    throw fileError(path.string(), "is not JSON", error.what());
  }
  return readAll(ReportField(json, path.string(), ""), folder);
}

}  // namespace gnomon
