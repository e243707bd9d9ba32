#include "lab/compare/results.h"

#include "lab/core/results_head.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

const char* lightTypeName(LightType type) {
  switch (type) {
    case LightType::Point:
      return "point";
    case LightType::Spot:
      return "spot";
    case LightType::Directional:
      return "directional";
  }
  return "";
}

Json toJson(const std::string& name, const LightModel& light) {
  Json json;
  json["name"] = name;
  json["type"] = lightTypeName(light.type);
  if (light.type != LightType::Directional) json["position"] = vectorJson(glm::vec3(light.positionW));
  if (light.type != LightType::Point) json["direction"] = vectorJson(glm::vec3(light.directionW));
  if (light.type == LightType::Spot)
    json["cone_degrees"] = shortest(static_cast<float>(2.0 * glm::degrees(light.outerConeRad)));
  return json;
}

Json toJson(const TruthSummary& truth) {
  Json json;
  json["map"] = truth.map;
  json["light"] = toJson(truth.lightName, truth.light);
  json["scored"] = truth.scored;
  json["lit"] = truth.lit;
  json["facing_away"] = truth.facingAway;
  json["outside_cone"] = truth.outsideCone;
  json["margin"] = truth.margin;
  json["margin_flips_half"] = truth.marginFlipsHalf;
  json["margin_flips_double"] = truth.marginFlipsDouble;
  json["z_near"] = shortest(truth.zNear);
  json["z_far"] = shortest(truth.zFar);
  json["fit_note"] = truth.fitNote;
  json["trace_ms"] = truth.receiversAndTraceMs;
  json["fit_ms"] = truth.fitMs;
  return json;
}

Json toJson(const Pictures& pictures) {
  Json json = Json::object();
  for (const auto& [name, path] : pictures) json[name] = path;
  return json;
}

Json toJson(const std::optional<WorstPlace>& place) {
  if (!place) return nullptr;
  return {{"x", place->x}, {"y", place->y}, {"size", place->size}, {"pixels", place->pixels}};
}

Json toJson(const std::optional<Elsewhere>& elsewhere, const char* key, const Json& where) {
  if (!elsewhere) return nullptr;
  return {{key, where},
          {"bias_error", elsewhere->biasError},
          {"best_bias_error", elsewhere->bestBiasError},
          {"best_value", shortest(static_cast<float>(elsewhere->bestValue))}};
}

Json toJson(const std::optional<Tuning>& tuning) {
  if (!tuning) return nullptr;
  return {{"knob", tuning->knob},
          {"value", shortest(static_cast<float>(tuning->value))},
          {"unit", tuning->unit},
          {"evaluations", tuning->evaluations},
          {"other_camera", toJson(tuning->otherCamera, "camera", tuning->otherCameraName)},
          {"other_map_size", toJson(tuning->otherMapSize, "map_size", tuning->otherMapSide)}};
}

Json toJson(const MapSummary& map) {
  Json json;
  json["map"] = map.map;
  json["light"] = map.light;
  json["map_size"] = map.side;
  json["layers"] = map.layers;
  json["z_near"] = shortest(map.zNear);
  json["z_far"] = shortest(map.zFar);
  json["texel_solid_angle"] = map.solidAngles
                                  ? Json{{"smallest", map.solidAngles->smallest}, {"largest", map.solidAngles->largest}}
                                  : Json(nullptr);
  json["pictures"] = toJson(map.pictures);
  json["truth_filtered"] = Json::object();
  for (const auto& [filter, pictures] : map.filteredTruths) json["truth_filtered"][filter] = toJson(pictures);
  return json;
}

Json toJson(const Row& row, double gbufferMs) {
  Json params = Json::object();
  Json units = Json::object();
  for (size_t i = 0; i < row.knobs.size(); ++i) {
    params[row.knobs[i].first] = shortest(static_cast<float>(row.knobs[i].second));
    units[row.knobs[i].first] = row.knobUnits[i];
  }
  if (!row.epsilonAt.empty()) params["epsilon_at"] = row.epsilonAt;
  params["map_content"] = row.content;
  params["cull"] = row.cull;
  for (const MapParam& param : row.mapParams)
    params[param.name] = param.isNumber ? Json::parse(param.text) : Json(param.text);
  Json json;
  json["map"] = row.map;
  json["light"] = row.light;
  json["sum"] = row.isSum;
  json["map_size"] = row.mapSide;
  json["layers"] = row.layers;
  json["map_texels"] = static_cast<uint64_t>(row.mapSide) * row.mapRows * row.layers;
  json["bias"] = row.bias;
  json["params"] = params;
  json["knob_units"] = units;
  json["filter"] = row.filter;
  json["tuned"] = row.tuning.has_value();
  json["scored"] = row.scored;
  json["agree"] = row.agree;
  json["acne"] = row.acne;
  json["leak"] = row.leak;
  json["edge_shadow"] = row.edgeShadow;
  json["edge_light"] = row.edgeLight;
  json["uncovered"] = row.uncovered;
  json["grazing"] = row.grazing;
  json["edge_on"] = row.edgeOn;
  json["bias_error"] = row.biasError();
  json["rmse"] = row.rmse;
  json["flip"] = row.flip ? Json(*row.flip) : Json(nullptr);
  json["build_ms"] = row.buildMs;
  json["shade_ms"] = row.shadeMs;
  json["frame_ms"] = gbufferMs + row.buildMs + row.shadeMs;
  json["tuning"] = toJson(row.tuning);
  json["worst_acne"] = toJson(row.worstAcne);
  json["worst_leak"] = toJson(row.worstLeak);
  json["command"] = row.command;
  json["pictures"] = toJson(row.pictures);
  return json;
}

}  // namespace

std::string resultsJson(const Session& session, const SetupOptions& setup, const Comparison& comparison,
                        const std::string& command) {
  Json json = resultsHead(session, setup, command, comparison.gbufferMs);
  json["light"] = toJson(comparison.truths.front().lightName, comparison.truths.front().light);
  json["truth"] = toJson(comparison.truths.front());
  json["truths"] = Json::array();
  for (const TruthSummary& truth : comparison.truths) json["truths"].push_back(toJson(truth));
  json["maps"] = Json::array();
  for (const MapSummary& map : comparison.maps) json["maps"].push_back(toJson(map));
  json["rows"] = Json::array();
  for (const Row& row : comparison.rows) json["rows"].push_back(toJson(row, comparison.gbufferMs));
  json["media"] = Json::array();  // of gnomon fog
  return json.dump(2) + "\n";
}

}  // namespace gnomon
