// The scene, its light and its camera: how they are set, and what moving them in the picture comes to.

#include "base/error.h"
#include "base/parse.h"
#include "lab/core/default_view.h"
#include "scene/generate.h"
#include "view/control_kinds.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

namespace {

using Kind = Control::Kind;

std::vector<std::string> generatedNames() {
  std::vector<std::string> names;
  for (const GeneratedScene& scene : generatedScenes()) names.emplace_back(scene.name);
  return names;
}

template <typename T>
std::vector<std::string> namesOf(const std::vector<T>& things) {
  std::vector<std::string> names;
  for (const T& thing : things) names.push_back(thing.name);
  return names;
}

// What --light names without a place: "lamp" of "lamp@1,2,3"; empty where it is a place alone.
std::string lightName(const std::string& text) {
  if (tryVec3(text)) return "";
  const size_t mark = text.rfind('@');
  return mark != std::string::npos && tryVec3(text.substr(mark + 1)) ? text.substr(0, mark) : text;
}

}  // namespace

void addScene(std::vector<Control>& controls) {
  controls.push_back(textControl({.name = "scene",
                                  .label = "scene",
                                  .group = "Scene",
                                  .sentence = "a glTF file (.gltf, .glb; drop one on the window), or a generated scene",
                                  .choices = generatedNames()},
                                 [](ViewState& state) -> std::string& { return state.setup.scene; }));
  controls.back().set = [](ViewState& state, const std::string& text) {
    if (text.empty()) throw UsageError("scene is empty; name a generated scene or a glTF file");
    if (text == state.setup.scene) return;
    checkNoStream(text);
    // Another scene has other lights and cameras.
    const std::string size = state.setup.size;
    state.setup = {.scene = text, .size = size};
  };
  Control solids{.name = "solids",
                 .label = "solids",
                 .group = "Scene",
                 .sentence =
                     "which meshes are solids, whose back faces the map may leave out: as the file says, all closed "
                     "ones, or those that hold no light or camera",
                 .kind = Kind::Choice,
                 .choices = solidsNames()};
  solids.get = [](const ViewState& state) { return std::string(solidsName(state.setup.choice.solids)); };
  solids.set = [](ViewState& state, const std::string& text) {
    checkChoice("solids", text, solidsNames());
    state.setup.choice.solids = parseSolids(text);
  };
  controls.push_back(solids);
  // "a, b" as a list of names.
  const auto addNames = [&](const char* name, const char* sentence, std::vector<std::string> SceneChoice::*member) {
    Control control{.name = name, .label = name, .group = "Scene", .sentence = sentence};
    control.get = [member](const ViewState& state) {
      return fmt::format("{}", fmt::join(state.setup.choice.*member, "\n"));
    };
    control.set = [member](ViewState& state, const std::string& text) {
      auto& names = state.setup.choice.*member;
      names.clear();
      for (size_t from = 0; from < text.size();) {
        const size_t to = std::min(text.find('\n', from), text.size());
        if (to > from) names.push_back(text.substr(from, to - from));
        from = to + 1;
      }
    };
    controls.push_back(control);
  };
  addNames("casters", "names of nodes or meshes, a line each: only these cast shadows", &SceneChoice::casters);
  addNames("exclude", "names, a line each, of what casts no shadow: a lamp's own bulb", &SceneChoice::excluded);
}

void addLight(std::vector<Control>& controls, const std::shared_ptr<const TracedScene>& traced) {
  controls.push_back(textControl(
      {.name = "light",
       .label = "light",
       .group = "Light",
       .sentence = "a light of the scene, NAME@x,y,z (that light, moved) or x,y,z; empty: the first that the map takes",
       .choices = traced ? namesOf(traced->scene.lights) : std::vector<std::string>()},
      [](ViewState& state) -> std::string& { return state.setup.light; }));
  const auto isPlaced = [traced](const ViewState& state) {
    try {
      return traced && lightOf(state, *traced).type != LightType::Directional;
    } catch (const std::exception&) {
      return false;  // there is no such light: the picture says so
    }
  };
  const Bounds bounds = traced ? traced->tracer.boundsW() : Bounds{};
  const glm::dvec3 origin = traced ? traced->scene.originW : glm::dvec3(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = 0.5 * static_cast<double>(bounds.diagonal());
    Control place{.name = fmt::format("light.{}", "xyz"[axis]),
                  .label = std::string(1, "xyz"[axis]),
                  .group = "Light",
                  .sentence = "where the light stands; it is dragged in the picture, too",
                  .unit = "m",
                  .kind = Kind::Number,
                  .lower = -kFarthestPlace,
                  .upper = kFarthestPlace,
                  .slideLower = static_cast<double>(bounds.lower[axis]) + origin[axis] - 0.25 * reach,
                  .slideUpper = static_cast<double>(bounds.upper[axis]) + origin[axis] + 0.25 * reach,
                  .derived = true};
    place.get = [traced, axis, origin](const ViewState& state) {
      if (!traced) return std::string("0");
      return fmt::format(
          "{}", static_cast<float>(static_cast<double>(lightOf(state, *traced).positionW[axis]) + origin[axis]));
    };
    place.set = [traced, axis, origin, name = place.name](ViewState& state, const std::string& text) {
      if (!traced) throw UsageError(name + ": there is no scene yet");
      glm::dvec3 position(lightOf(state, *traced).positionW);
      position[axis] = numberIn(name, text, -kFarthestPlace, kFarthestPlace, "m") - origin[axis];
      moveLight(state, *traced, position);
    };
    place.applies = isPlaced;
    controls.push_back(place);
  }
  Control direction = textControl({.name = "direction",
                                   .label = "direction",
                                   .group = "Light",
                                   .sentence = "x,y,z: the way in which the light shines; empty: the light's own"},
                                  [](ViewState& state) -> std::string& { return state.setup.direction; });
  direction.set = [](ViewState& state, const std::string& text) {
    if (!text.empty() && parseVec3("direction", text) == glm::vec3(0.0f))
      throw UsageError("direction 0,0,0 has no direction; write x,y,z");
    state.setup.direction = text;
  };
  controls.push_back(direction);
  controls.push_back(
      optionalControl({.name = "cone",
                       .label = "cone",
                       .group = "Light",
                       .sentence = "full angle of a spot's cone; empty: the light's own, else 120",
                       .unit = "degrees",
                       .lower = 1.0,
                       .upper = 180.0,
                       .slideLower = 1.0,
                       .slideUpper = 180.0},
                      [](ViewState& state) -> std::optional<double>& { return state.setup.coneDegrees; }));
  controls.push_back(optionalControl({.name = "intensity",
                                      .label = "intensity",
                                      .group = "Light",
                                      .sentence = "candela, or lux of a directional light; empty: the light's own",
                                      .unit = "cd",
                                      .lower = 1e-12,
                                      .upper = 1e12,
                                      .slideLower = 0.01,
                                      .slideUpper = 1e5,
                                      .logarithmic = true},
                                     [](ViewState& state) -> std::optional<double>& { return state.setup.intensity; }));
}

void addCamera(std::vector<Control>& controls, const std::shared_ptr<const TracedScene>& traced) {
  controls.push_back(textControl(
      {.name = "camera",
       .label = "camera",
       .group = "Camera",
       .sentence = "a camera of the scene, or eye:x,y,z,target:x,y,z[,fov:degrees]; drag in the picture to turn round, "
                   "W A S D to fly; empty: the scene's first",
       .choices = traced ? namesOf(traced->scene.cameras) : std::vector<std::string>()},
      [](ViewState& state) -> std::string& { return state.setup.camera; }));
  Control size = textControl({.name = "size",
                              .label = "size",
                              .group = "Camera",
                              .sentence = "of the picture: N or WxH; empty: as large as the window has room",
                              .unit = "pixels"},
                             [](ViewState& state) -> std::string& { return state.setup.size; });
  size.set = [](ViewState& state, const std::string& text) {
    if (!text.empty()) parseSize(text);
    state.setup.size = text;
  };
  controls.push_back(size);
  controls.push_back(
      numberControl({.name = "budget",
                     .label = "time budget",
                     .group = "Camera",
                     .sentence = "how long a picture may take while something moves: it is drawn with fewer "
                                 "pixels until that holds, and in full when all is at rest",
                     .unit = "ms",
                     .lower = 1.0,
                     .upper = 10000.0,
                     .slideLower = 10.0,
                     .slideUpper = 500.0,
                     .logarithmic = true},
                    [](ViewState& state) -> double& { return state.budgetMs; }));
}

void addExposure(std::vector<Control>& controls) {
  Control exposure{.name = "exposure",
                   .label = "exposure",
                   .group = "Camera",
                   .sentence = "factor from cd/m^2 to the picture's values; empty: one that suits each picture",
                   .unit = "1/(cd/m^2)",
                   .kind = Kind::Number,
                   .lower = 1e-12,
                   .upper = 1e12,
                   .slideLower = 1e-3,
                   .slideUpper = 1e3,
                   .logarithmic = true};
  exposure.get = [](const ViewState& state) {
    const auto& value = state.sides[0].options.exposure;
    return value ? fmt::format("{}", *value) : std::string();
  };
  exposure.set = [exposure](ViewState& state, const std::string& text) {
    std::optional<float> value;
    if (!text.empty())
      value = static_cast<float>(numberIn(exposure.name, text, exposure.lower, exposure.upper, exposure.unit));
    for (ViewSide& side : state.sides) side.options.exposure = value;
  };
  controls.push_back(exposure);
}

Light lightOf(const ViewState& state, const TracedScene& traced) {
  return chooseLight(state.setup, traced.tracer, *state.sides[0].options.maps.front());
}

void moveLight(ViewState& state, const TracedScene& traced, const glm::dvec3& positionW) {
  const Light light = lightOf(state, traced);
  if (light.type == LightType::Directional) {
    const glm::dvec3 towards = glm::dvec3(traced.tracer.boundsW().center()) - positionW;
    state.setup.direction = fmt::format("{},{},{}", static_cast<float>(towards.x), static_cast<float>(towards.y),
                                        static_cast<float>(towards.z));
    return;
  }
  const glm::dvec3 place = positionW + traced.scene.originW;
  checkPlace("light", place);
  // As floats near the origin; far from it the scene's own coordinates need more digits.
  const bool far = traced.scene.originW != glm::dvec3(0.0);
  const auto text = [&](double value) {
    return far ? fmt::format("{}", value) : fmt::format("{}", static_cast<float>(value));
  };
  const std::string at = fmt::format("{},{},{}", text(place.x), text(place.y), text(place.z));
  std::string name = lightName(state.setup.light);
  if (name.empty() && !traced.scene.lights.empty() && state.setup.light.empty()) name = light.name;
  // A name by number or the end of a path stays what it was typed as.
  state.setup.light = name.empty() ? at : name + "@" + at;
}

void placeCamera(ViewState& state, const TracedScene& traced, const glm::dvec3& eyeW, const glm::dvec3& targetW,
                 double fovDegrees) {
  const auto text = [&](const glm::dvec3& placeW) {
    const glm::dvec3 place = placeW + traced.scene.originW;
    checkPlace("camera", place);
    if (traced.scene.originW != glm::dvec3(0.0)) return fmt::format("{},{},{}", place.x, place.y, place.z);
    return fmt::format("{},{},{}", static_cast<float>(place.x), static_cast<float>(place.y),
                       static_cast<float>(place.z));
  };
  if (text(eyeW) == text(targetW)) return;
  const double fov = std::clamp(fovDegrees, 1.0, 170.0);
  state.setup.camera = fmt::format("eye:{},target:{},fov:{}", text(eyeW), text(targetW), static_cast<float>(fov));
}

}  // namespace gnomon
