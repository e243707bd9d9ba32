#include "lab/sweep/scene_survey.h"

#include "base/error.h"
#include "base/file.h"
#include "base/parse_json.h"
#include "lab/store/content_hash.h"
#include "scene/generate.h"
#include "scene/gltf_buffers.h"

#include <cstring>

#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kNote = "survey ";

template <typename T>
Json numbersOf(const T* values, int count) {
  Json list = Json::array();
  for (int i = 0; i < count; ++i) list.push_back(static_cast<double>(values[i]));
  return list;
}

void readNumbers(const Json& list, float* values, int count) {
  for (int i = 0; i < count; ++i) values[i] = list.at(static_cast<size_t>(i)).get<float>();
}

Json jsonOf(const Chosen<Light>& light) {
  Json json = Json::object();
  json["name"] = light.name;
  json["text"] = light.text;
  json["own_name"] = light.thing.name;
  json["path"] = light.thing.path;
  json["type"] = static_cast<int>(light.thing.type);
  json["position"] = numbersOf(&light.thing.positionW.x, 3);
  json["direction"] = numbersOf(&light.thing.directionW.x, 3);
  json["color"] = numbersOf(&light.thing.color.x, 3);
  json["intensity"] = static_cast<double>(light.thing.intensity);
  json["inner"] = static_cast<double>(light.thing.innerConeRad);
  json["outer"] = static_cast<double>(light.thing.outerConeRad);
  return json;
}

Chosen<Light> lightOf(const Json& json) {
  Chosen<Light> light{json.at("name"), json.at("text"), {}};
  light.thing.name = json.at("own_name");
  light.thing.path = json.at("path");
  light.thing.type = static_cast<LightType>(json.at("type").get<int>());
  readNumbers(json.at("position"), &light.thing.positionW.x, 3);
  readNumbers(json.at("direction"), &light.thing.directionW.x, 3);
  readNumbers(json.at("color"), &light.thing.color.x, 3);
  light.thing.intensity = json.at("intensity");
  light.thing.innerConeRad = json.at("inner");
  light.thing.outerConeRad = json.at("outer");
  return light;
}

Json jsonOf(const Chosen<Camera>& camera) {
  Json json = Json::object();
  json["name"] = camera.name;
  json["text"] = camera.text;
  json["own_name"] = camera.thing.name;
  json["path"] = camera.thing.path;
  json["world_from_eye"] = numbersOf(&camera.thing.worldFromEye[0][0], 16);
  json["fov"] = static_cast<double>(camera.thing.yFovRad);
  json["near"] = static_cast<double>(camera.thing.zNear);
  json["aspect"] = camera.thing.aspect;
  return json;
}

Chosen<Camera> cameraOf(const Json& json) {
  Chosen<Camera> camera{json.at("name"), json.at("text"), {}};
  camera.thing.name = json.at("own_name");
  camera.thing.path = json.at("path");
  readNumbers(json.at("world_from_eye"), &camera.thing.worldFromEye[0][0], 16);
  camera.thing.yFovRad = json.at("fov");
  camera.thing.zNear = json.at("near");
  camera.thing.aspect = json.at("aspect");
  return camera;
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
  for (const Json& light : json.at("lights")) survey.scene.lights.push_back(lightOf(light));
  for (const Json& camera : json.at("cameras")) survey.scene.cameras.push_back(cameraOf(camera));
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
