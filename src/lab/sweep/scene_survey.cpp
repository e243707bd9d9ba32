#include "lab/sweep/scene_survey.h"

#include "base/error.h"
#include "base/file.h"
#include "base/parse_json.h"
#include "lab/store/content_hash.h"
#include "scene/generate.h"
#include "scene/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kNote = "survey ";

template <class T, class Wanted>
concept MaybeConst = std::is_same_v<std::remove_const_t<T>, Wanted>;

// member(name, value) for each, of what writes them and of what reads them.
void visit(MaybeConst<Chosen<Light>> auto& light, const auto& member) {
  member("name", light.name);
  member("text", light.text);
  member("own_name", light.thing.name);
  member("path", light.thing.path);
  member("type", light.thing.type);
  member("position", light.thing.positionW);
  member("direction", light.thing.directionW);
  member("color", light.thing.color);
  member("intensity", light.thing.intensity);
  member("inner", light.thing.innerConeRad);
  member("outer", light.thing.outerConeRad);
}

void visit(MaybeConst<Chosen<Camera>> auto& camera, const auto& member) {
  member("name", camera.name);
  member("text", camera.text);
  member("own_name", camera.thing.name);
  member("path", camera.thing.path);
  member("world_from_eye", camera.thing.worldFromEye);
  member("fov", camera.thing.yFovRad);
  member("near", camera.thing.zNear);
  member("aspect", camera.thing.aspect);
}

// Vectors and matrices are lists of numbers.
template <class T>
concept OfFloats = std::is_same_v<T, glm::vec3> || std::is_same_v<T, glm::mat4>;

template <class Place>
Json jsonOf(const Place& place) {
  Json json = Json::object();
  visit(place, [&json]<class T>(const char* name, const T& value) {
    if constexpr (OfFloats<T>) {
      const float* first = glm::value_ptr(value);
      json[name] = std::vector<float>(first, first + sizeof(T) / sizeof(float));
    } else {
      json[name] = value;
    }
  });
  return json;
}

template <class Place>
Place placeOf(const Json& json) {
  Place place{};
  visit(place, [&json]<class T>(const char* name, T& value) {
    if constexpr (OfFloats<T>)
      std::ranges::copy(json.at(name).get<std::array<float, sizeof(T) / sizeof(float)>>(), glm::value_ptr(value));
    else
      value = json.at(name).get<T>();
  });
  return place;
}

void addUris(const Json& json, std::set<std::string>& uris) {
  for (const auto& [name, value] : json.items()) {
    if (value.is_structured()) addUris(value, uris);
    if (name == "uri" && value.is_string()) uris.insert(value.get<std::string>());
  }
}

Json hashesOf(const std::string& source) {
  Json hashes = Json::object();
  std::error_code failure;
  for (const fs::path& file : filesOfScene(source))
    hashes[file.string()] = fs::is_regular_file(file, failure) ? hashOf(readFile(file)) : "none";
  return hashes;
}

SceneSurvey surveyOf(const Json& json) {
  SceneSurvey survey;
  survey.scene.hash = json.at("hash");
  survey.scene.triangles = json.at("triangles");
  survey.scene.diagonal = json.at("diagonal");
  for (const Json& light : json.at("lights")) survey.scene.lights.push_back(placeOf<Chosen<Light>>(light));
  for (const Json& camera : json.at("cameras")) survey.scene.cameras.push_back(placeOf<Chosen<Camera>>(camera));
  for (const Json& where : json.at("found")) survey.found.insert(where.get<std::string>());
  for (const Json& pair : json.at("missing")) survey.missing.emplace_back(pair.at(0), pair.at(1));
  return survey;
}

}  // namespace

std::vector<fs::path> filesOfScene(const std::string& source) {
  std::error_code failure;
  if (findGeneratedScene(source) != nullptr || !fs::is_regular_file(source, failure)) return {};
  std::vector<fs::path> files = {source};
  std::string text = readFile(source);
  if (text.starts_with("glTF")) {  // glTF 2.0, section 4.4: after a header of 12 bytes the JSON chunk, its length first
    uint32_t length = 0;
    if (text.size() >= 20) std::memcpy(&length, text.data() + 12, sizeof(length));
    text = text.size() >= 20 ? text.substr(20, length) : "";
  }
  std::set<std::string> uris;
  try {
    addUris(parseJson<Json>(text, {}), uris);
  } catch (const Json::exception&) {  // whoever opens it says what is wrong
  }
  for (const std::string& uri : uris)
    if (!uri.starts_with("data:")) files.push_back(files.front().parent_path() / percentDecoded(uri));
  return files;
}

std::string surveyKey(const Plan& plan, const Axes& axes, const SweepScene& scene) {
  ContentHash hash;
  hash.add(scene.name);
  for (const std::string& word : setupWords(scene.setup)) hash.add(word);
  hash.add(plan.seed);
  for (const std::vector<PlanPlace>* places : {&plan.lights, &plan.cameras}) {
    hash.add(places->size());
    for (const PlanPlace& place : *places) {
      hash.add(place.where);
      hash.add(place.name);
      hash.add(place.random);
    }
  }
  for (const SweepMap& map : axes.maps) hash.add(map.map->name());
  return hash.digits();
}

std::optional<SceneSurvey> knownSurvey(const Store& store, const std::string& key, const std::string& program,
                                       const std::string& source) {
  const std::optional<std::string> text = store.note(kNote + key);
  if (!text) return std::nullopt;
  try {
    const Json json = Json::parse(*text);
    if (json.at("program") != program) return std::nullopt;
    SceneSurvey survey = surveyOf(json);
    if (hashesOf(source) != json.at("files")) return std::nullopt;
    return survey;
  } catch (const WorldError&) {  // a file is gone
  } catch (const Json::exception&) {
  }
  return std::nullopt;
}

void keepSurvey(Store& store, const std::string& key, const std::string& program, const std::string& source,
                const SceneSurvey& survey) {
  Json json = Json::object();
  json["program"] = program;
  json["hash"] = survey.scene.hash;
  json["triangles"] = survey.scene.triangles;
  json["diagonal"] = survey.scene.diagonal;
  for (const char* list : {"lights", "cameras", "found", "missing"}) json[list] = Json::array();
  for (const Chosen<Light>& light : survey.scene.lights) json["lights"].push_back(jsonOf(light));
  for (const Chosen<Camera>& camera : survey.scene.cameras) json["cameras"].push_back(jsonOf(camera));
  for (const std::string& where : survey.found) json["found"].push_back(where);
  for (const auto& [where, complaint] : survey.missing) {
    Json pair = Json::array();
    pair.push_back(where);
    pair.push_back(complaint);
    json["missing"].push_back(std::move(pair));
  }
  json["files"] = hashesOf(source);
  store.setNote(kNote + key, json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace gnomon
