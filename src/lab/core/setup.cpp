#include "lab/core/setup.h"

#include "base/error.h"
#include "base/suggest.h"
#include "judge/ground_truth.h"

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

// Whether looking down on the scene one sees nothing but its top: a room with a roof, whose inside is meant.
bool isRoofed(const Tracer& tracer, const Bounds& bounds) {
  constexpr int kGrid = 7;
  const glm::vec3 extent = bounds.upper - bounds.lower;
  int covered = 0;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const double u = 0.2 + 0.6 * (i % kGrid) / (kGrid - 1);
    const double v = 0.2 + 0.6 * (i / kGrid) / (kGrid - 1);
    const glm::dvec3 origin(bounds.lower.x + u * extent.x, bounds.upper.y + extent.y + 1.0,
                            bounds.lower.z + v * extent.z);
    const std::optional<SurfaceHit> hit = tracer.firstHit({.origin = origin, .dir = {0, -1, 0}});
    if (hit && origin.y - hit->distance > bounds.upper.y - 0.25 * extent.y) ++covered;
  }
  return covered > 9 * kGrid * kGrid / 10;
}

// A little off the vertical through the centre, so that no symmetry of the scene hides an artefact.
Light lightAboveCenter(const Tracer& tracer) {
  const Bounds bounds = computeBounds(tracer.scene());
  const glm::vec3 extent = bounds.upper - bounds.lower;
  Light light;
  light.name = "above the centre";
  light.positionW = bounds.center() + glm::vec3(0.07f, 0.0f, 0.05f) * bounds.diagonal();
  light.positionW.y =
      isRoofed(tracer, bounds) ? bounds.center().y + 0.3f * extent.y : bounds.upper.y + 0.5f * bounds.diagonal();
  const float distance = light.positionW.y - bounds.lower.y;
  light.intensity = 10.0f * distance * distance;
  return light;
}

Camera cameraThatSees(const Tracer& tracer) {
  const Bounds bounds = computeBounds(tracer.scene());
  const glm::vec3 extent = bounds.upper - bounds.lower;
  if (isRoofed(tracer, bounds)) {
    const glm::vec3 eye = bounds.center() + extent * glm::vec3(0.4f, 0.15f, 0.4f);
    return lookAt("from a corner", eye, bounds.center() - extent * glm::vec3(0.1f, 0.15f, 0.1f), 1.2f);
  }
  constexpr float kFov = 0.7854f;  // 45 degrees
  const float distance = 0.5f * bounds.diagonal() / std::sin(0.5f * kFov);
  const glm::vec3 eye = bounds.center() + glm::normalize(glm::vec3(0.55f, 0.5f, 0.8f)) * distance;
  return lookAt("sees the scene", eye, bounds.center(), kFov);
}

Light defaultLight(const Tracer& tracer, const Parameterization& map) {
  const Light* first = firstLightFor(tracer.scene(), map);
  return first != nullptr ? *first : lightAboveCenter(tracer);
}

Light findLight(const Scene& scene, const std::string& text) {
  const auto named = std::ranges::find(scene.lights, text, &Light::name);
  if (named != scene.lights.end()) return *named;
  const std::optional<glm::vec3> position = tryVec3(text);
  if (!position)
    throw WorldError(fmt::format("--light {}: the scene has no light of this name; {}; or write x,y,z", text,
                                 whatItHas(text, scene.lights)));
  Light light;
  light.name = text;
  light.positionW = *position;
  const float distance = std::max(glm::distance(*position, computeBounds(scene).center()), 1e-3f);
  light.intensity = 10.0f * distance * distance;
  return light;
}

// eye:x,y,z,target:x,y,z[,fov:deg]
Camera parseCamera(const std::string& text) {
  std::optional<glm::vec3> eye, target;
  double fov = 60.0;
  std::string key, value;
  const auto take = [&] {
    if (key.empty()) return;
    if (key == "eye")
      eye = parseVec3("--camera eye", value);
    else if (key == "target")
      target = parseVec3("--camera target", value);
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
  return lookAt("from the command line", *eye, *target, static_cast<float>(glm::radians(fov)));
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
  add("--size", options.size, defaults.size);
  return words;
}

PictureSize parseSize(const std::string& text) {
  PictureSize size;
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
    throw UsageError(fmt::format("--size {}: write N or WxH, each 1..16384 pixels", text));
  return size;
}

Light chooseLight(const SetupOptions& options, const Tracer& tracer, const Parameterization& map) {
  const Scene& scene = tracer.scene();
  Light light = options.light.empty() ? defaultLight(tracer, map) : findLight(scene, options.light);
  if (!options.direction.empty()) {
    const glm::vec3 direction = parseVec3("--direction", options.direction);
    if (glm::length(direction) == 0.0f) throw UsageError("--direction 0,0,0 has no direction; write x,y,z");
    light.directionW = glm::normalize(direction);
    if (light.type == LightType::Point) light.type = LightType::Spot;
  }
  if (options.coneDegrees) {
    if (!(*options.coneDegrees >= 1.0 && *options.coneDegrees <= 170.0))
      throw UsageError(fmt::format("--cone {}: a spot's full angle is 1..170 degrees", *options.coneDegrees));
    light.outerConeRad = static_cast<float>(glm::radians(0.5 * *options.coneDegrees));
  }
  if (map.supportsLight(light.type) == LightSupport::No)
    throw WorldError(
        fmt::format("--light {}: a directional light has no position, which a {} map needs; use --maps directional, "
                    "another light, or x,y,z",
                    light.name, map.name()));
  return light;
}

std::vector<Light> chooseLights(const SetupOptions& options, const Tracer& tracer, const Parameterization& map) {
  if (options.light != "all") return {chooseLight(options, tracer, map)};
  std::vector<Light> lights;
  for (const auto wanted : {LightSupport::Yes, LightSupport::Fallback}) {
    if (!lights.empty()) break;
    for (const Light& light : tracer.scene().lights) {
      if (map.supportsLight(light.type) != wanted) continue;
      SetupOptions one = options;
      one.light = light.name;
      lights.push_back(chooseLight(one, tracer, map));
    }
  }
  if (lights.empty())
    throw WorldError(fmt::format("--light all: the scene has no light that a {} map supports; it has {}; write x,y,z",
                                 map.name(), namesOf(tracer.scene().lights)));
  return lights;
}

Camera chooseCamera(const SetupOptions& options, const Tracer& tracer) {
  const Scene& scene = tracer.scene();
  if (options.camera.empty()) return scene.cameras.empty() ? cameraThatSees(tracer) : scene.cameras.front();
  const auto named = std::ranges::find(scene.cameras, options.camera, &Camera::name);
  if (named != scene.cameras.end()) return *named;
  if (options.camera.find(':') != std::string::npos) return parseCamera(options.camera);
  throw WorldError(
      fmt::format("--camera {}: the scene has no camera of this name; {}; or write "
                  "eye:x,y,z,target:x,y,z[,fov:degrees]",
                  options.camera, whatItHas(options.camera, scene.cameras)));
}

}  // namespace gnomon
