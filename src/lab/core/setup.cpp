#include "lab/core/setup.h"

#include "base/error.h"
#include "base/suggest.h"
#include "judge/ground_truth.h"
#include "lab/core/default_view.h"
#include "lab/core/maps.h"
#include "scene/generate.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

namespace gnomon {

namespace {

template <typename T>
std::string namesOf(const std::vector<T>& things) {
  std::string names;
  for (const T& thing : things) names += (names.empty() ? "" : ", ") + thing.name;
  return names.empty() ? "none" : names;
}

// "it has a, b", or "did you mean a? It has a, b".
template <typename T>
std::string whatItHas(const std::string& wanted, const std::vector<T>& things) {
  std::vector<std::string> names;
  for (const T& thing : things) names.push_back(thing.name);
  const std::string nearest = nearestName(wanted, names);
  return nearest.empty() ? "it has " + namesOf(things)
                         : fmt::format("did you mean {}? It has {}", nearest, namesOf(things));
}

// As in glTF: a spot that shines into half of all directions.
constexpr double kWidestConeDegrees = 180.0;

// The scene's own light that suits the map, or the default one.
Light lightFor(const Tracer& tracer, const Parameterization& map) {
  const Light* first = firstLightFor(tracer.scene(), map);
  return first != nullptr ? *first : defaultLight(tracer);
}

// The thing that `text` names: by its name, its number ("#2"), or the end of its node's path ("lamp" or "rig/lamp" of
// "yard/rig/lamp"). Null where there is none. Throws UsageError where several paths end so.
template <typename T>
const T* findNamed(const std::vector<T>& things, const std::string& flag, const std::string& text) {
  const auto named = std::ranges::find(things, text, &T::name);
  if (named != things.end()) return &*named;
  if (text.starts_with('#'))
    if (const std::optional<double> number = parseNumber(text.substr(1)))
      for (size_t i = 0; i < things.size(); ++i)
        if (*number == static_cast<double>(i)) return &things[i];
  std::vector<T> ending;
  const T* found = nullptr;
  for (const T& thing : things) {
    if (thing.path != text && !thing.path.ends_with("/" + text)) continue;
    ending.push_back(thing);
    found = &thing;
  }
  if (ending.size() > 1)
    throw UsageError(fmt::format("{} {}: several are called so; write one of {}", flag, text, namesOf(ending)));
  return found;
}

// A light of no file. It has the power of the scene's first lamp, or one that suits the distance to the scene's centre.
Light lightAt(const Scene& scene, const glm::vec3& positionW, const std::string& name) {
  Light light;
  light.name = name;
  light.positionW = positionW;
  const auto lamp = std::ranges::find_if(scene.lights, [](const Light& l) { return l.type != LightType::Directional; });
  if (lamp != scene.lights.end()) {
    light.color = lamp->color;
    light.intensity = lamp->intensity;
    return light;
  }
  const Bounds bounds = computeBounds(scene);
  const float distance = std::max(glm::distance(positionW, bounds.center()), 1e-4f * bounds.diagonal());
  light.intensity = 10.0f * distance * distance;
  return light;
}

Light findLight(const Scene& scene, const std::string& text) {
  if (const Light* named = findNamed(scene.lights, "--light", text)) return *named;
  const auto placed = [&](const glm::dvec3& position) { return glm::vec3(position - scene.originW); };
  const size_t at = text.rfind('@');
  if (at != std::string::npos) {
    const std::optional<glm::dvec3> position = tryVec3(text.substr(at + 1));
    const Light* named = findNamed(scene.lights, "--light", text.substr(0, at));
    if (position && named && named->type != LightType::Directional) {
      checkPlace("--light", *position);
      Light moved = *named;
      moved.name = text;
      moved.positionW = placed(*position);
      return moved;
    }
  }
  const std::optional<glm::dvec3> position = tryVec3(text);
  if (!position)
    throw UsageError(fmt::format("--light {}: the scene has no light of this name; {}; or write x,y,z", text,
                                 whatItHas(text, scene.lights)));
  checkPlace("--light", *position);
  return lightAt(scene, placed(*position), text);
}

// eye:x,y,z,target:x,y,z[,fov:deg]
Camera parseCamera(const Scene& scene, const std::string& text) {
  std::optional<glm::dvec3> eye, target;
  double fov = 60.0;
  std::string key, value;
  const auto take = [&] {
    if (key.empty()) return;
    if (key == "eye")
      eye = parsePlace("--camera eye", value);
    else if (key == "target")
      target = parsePlace("--camera target", value);
    else if (key == "fov" && parseNumber(value))
      fov = *parseNumber(value);
    else
      throw UsageError(fmt::format("--camera {}: '{}:{}' is not understood; write eye:x,y,z,target:x,y,z[,fov:degrees]",
                                   text, key, value));
  };
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    const size_t colon = word.find(':');
    if (colon == std::string::npos) {
      value += "," + word;
      continue;
    }
    take();
    key = word.substr(0, colon);
    value = word.substr(colon + 1);
  }
  take();
  if (!eye || !target || *eye == *target)
    throw UsageError(fmt::format(
        "--camera {}: needs an eye and a target that differ; write eye:x,y,z,target:x,y,z[,fov:degrees]", text));
  if (!(fov >= 1.0 && fov <= 170.0))
    throw UsageError(fmt::format("--camera {}: fov {} is outside 1..170 degrees", text, fov));
  Camera camera = lookAt("from the command line", glm::vec3(*eye - scene.originW), glm::vec3(*target - scene.originW),
                         static_cast<float>(glm::radians(fov)));
  camera.zNear = defaultNearPlane(computeBounds(scene));
  return camera;
}

// The light, with what --direction, --cone and --intensity change. Throws where the map does not support it.
Light asAsked(Light light, const SetupOptions& options, const Parameterization& map) {
  if (options.intensity) {
    if (!(*options.intensity > 0.0 && *options.intensity <= 1e12))
      throw UsageError(
          fmt::format("--intensity {}: give candela (or lux), more than 0 and at most 1e12", *options.intensity));
    light.intensity = static_cast<float>(*options.intensity);
  }
  if (!options.direction.empty()) {
    const glm::vec3 direction = parseVec3("--direction", options.direction);
    if (direction == glm::vec3(0.0f)) throw UsageError("--direction 0,0,0 has no direction; write x,y,z");
    light.directionW = glm::vec3(glm::normalize(glm::dvec3(direction)));  // of any length
    if (light.type == LightType::Point) light.type = LightType::Spot;
  }
  if (options.coneDegrees) {
    if (!(*options.coneDegrees >= 1.0 && *options.coneDegrees <= kWidestConeDegrees))
      throw UsageError(
          fmt::format("--cone {}: a spot's full angle is 1..{:g} degrees", *options.coneDegrees, kWidestConeDegrees));
    light.outerConeRad = static_cast<float>(glm::radians(0.5 * *options.coneDegrees));
  }
  if (map.supportsLight(light.type) == LightSupport::No)
    throw UsageError(
        fmt::format("--light {}: a directional light has no position, which a {} map needs; use --maps directional, "
                    "another light, or x,y,z",
                    light.name, map.name()));
  return light;
}

}  // namespace

std::vector<std::string> setupWords(const SetupOptions& options) {
  std::vector<std::string> words = {options.scene};
  const auto add = [&](const char* flag, const std::string& value, const std::string& usual) {
    if (value != usual) words.insert(words.end(), {flag, value});
  };
  const SetupOptions defaults;
  add("--light", options.light, defaults.light);
  add("--camera", options.camera, defaults.camera);
  add("--direction", options.direction, defaults.direction);
  if (options.coneDegrees) add("--cone", fmt::format("{}", *options.coneDegrees), "");
  if (options.intensity) add("--intensity", fmt::format("{}", *options.intensity), "");
  add("--size", options.size, defaults.size);
  for (const std::string& name : options.choice.casters) add("--casters", name, "");
  for (const std::string& name : options.choice.excluded) add("--exclude", name, "");
  if (options.choice.solids != defaults.choice.solids) add("--solids", solidsName(options.choice.solids), "");
  if (options.gltf.scene) add("--scene-index", fmt::format("{}", *options.gltf.scene), "");
  for (const std::filesystem::path& folder : options.gltf.allowedFolders) add("--allow-path", folder.string(), "");
  return words;
}

Scene openScene(const SetupOptions& options) {
  if (options.gltf.scene && findGeneratedScene(options.scene) != nullptr)
    throw UsageError(
        fmt::format("--scene-index {}: {} is a generated scene, and only one", *options.gltf.scene, options.scene));
  Scene scene = openScene(options.scene, options.gltf);
  applyChoice(scene, options.choice);
  return scene;
}

PictureSize parseSize(const std::string& text, double aspect, std::string_view flag) {
  PictureSize size;
  if (text.empty()) {
    const double ratio = aspect > 0.0 ? aspect : 1.0;
    const auto shorter = [](double share) { return std::max(static_cast<int>(std::lround(kDefaultSide * share)), 1); };
    if (ratio >= 1.0) return {.width = kDefaultSide, .height = shorter(1.0 / ratio)};
    return {.width = shorter(ratio), .height = kDefaultSide};
  }
  char by = 0, rest = 0;
  std::istringstream in(text);
  in >> size.width;
  if (in >> by) {
    in >> size.height;
    if (by != 'x' || !in || in >> rest) size.width = 0;
  } else {
    size.height = size.width;
  }
  if (size.width < 1 || size.height < 1 || size.width > 16384 || size.height > 16384)
    throw UsageError(fmt::format("{} {}: write N or WxH, each 1..16384 pixels", flag, text));
  return size;
}

Light chooseLight(const SetupOptions& options, const Tracer& tracer, const Parameterization& map) {
  const Light light = options.light.empty() ? lightFor(tracer, map) : findLight(tracer.scene(), options.light);
  return asAsked(light, options, map);
}

std::vector<Light> chooseLights(const SetupOptions& options, const Tracer& tracer, const Parameterization& map) {
  if (options.light != "all") return {chooseLight(options, tracer, map)};
  std::vector<Light> lights;
  for (const auto wanted : {LightSupport::Yes, LightSupport::Fallback}) {
    if (!lights.empty()) break;
    for (const Light& light : tracer.scene().lights) {
      if (map.supportsLight(light.type) != wanted) continue;
      lights.push_back(asAsked(light, options, map));
    }
  }
  if (lights.empty())
    throw WorldError(fmt::format("--light all: the scene has no light that a {} map supports; it has {}; write x,y,z",
                                 map.name(), namesOf(tracer.scene().lights)));
  return lights;
}

std::vector<Light> lightsAsked(const SetupOptions& options, const Tracer& tracer) {
  if (options.light.empty() || options.light == "all") return tracer.scene().lights;
  return {findLight(tracer.scene(), options.light)};
}

const Parameterization& usualMapOf(const SetupOptions& options, const Tracer& tracer, const MapOptions& mapOptions) {
  const std::vector<Light> lights = lightsAsked(options, tracer);
  LightType type = lights.empty() ? LightType::Point : lights.front().type;
  const bool hasCone = !options.direction.empty() || options.coneDegrees;
  if (type == LightType::Point && hasCone) type = LightType::Spot;
  return usualMapFor(type, mapOptions);
}

Camera chooseCamera(const SetupOptions& options, const Tracer& tracer) {
  const Scene& scene = tracer.scene();
  if (options.camera.empty()) {
    if (!scene.cameras.empty()) return scene.cameras.front();
    const bool named = !options.light.empty() && options.light != "all";
    return defaultCamera(tracer, named                  ? findLight(scene, options.light)
                                 : scene.lights.empty() ? defaultLight(tracer)
                                                        : scene.lights.front());
  }
  if (const Camera* named = findNamed(scene.cameras, "--camera", options.camera)) return *named;
  if (options.camera.find(':') != std::string::npos) return parseCamera(scene, options.camera);
  throw UsageError(
      fmt::format("--camera {}: the scene has no camera of this name; {}; or write "
                  "eye:x,y,z,target:x,y,z[,fov:degrees]",
                  options.camera, whatItHas(options.camera, scene.cameras)));
}

}  // namespace gnomon
