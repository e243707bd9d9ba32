#include "view/view_controls.h"

#include "base/error.h"
#include "base/parse.h"
#include "base/parse_json.h"
#include "base/suggest.h"
#include "judge/ground_truth.h"
#include "lab/compare/render_picture.h"
#include "lab/core/default_view.h"
#include "lab/core/maps.h"
#include "scene/generate.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

using Kind = Control::Kind;

double numberIn(const std::string& name, const std::string& text, double lower, double upper, const std::string& unit) {
  const std::optional<double> value = parseNumber(text);
  if (!value) throw UsageError(fmt::format("{} {}: is not a number", name, text));
  if (!(*value >= lower && *value <= upper))
    throw UsageError(fmt::format("{} {} is outside {:g}..{:g} {}", name, text, lower, upper, unit));
  return *value;
}

bool toggleIn(const std::string& name, const std::string& text) {
  if (text == "on" || text == "true" || text == "1") return true;
  if (text == "off" || text == "false" || text == "0") return false;
  throw UsageError(fmt::format("{} {}: write on or off", name, text));
}

std::string onOff(bool value) {
  return value ? "on" : "off";
}

void checkChoice(const std::string& name, const std::string& text, const std::vector<std::string>& choices) {
  if (std::ranges::find(choices, text) == choices.end())
    throw UsageError(fmt::format("{} {}: no such choice; {}", name, text,
                                 chooseFrom(text, fmt::format("{}", fmt::join(choices, ", ")))));
}

// Where a member of the state is.
template <typename T>
using Place = std::function<T&(ViewState&)>;

template <typename T>
T& at(const Place<T>& place, const ViewState& state) {
  return place(const_cast<ViewState&>(state));  // NOLINT: read only, by `get`
}

Control numberControl(Control control, const Place<double>& place) {
  control.kind = Kind::Number;
  control.get = [place](const ViewState& state) { return fmt::format("{}", at(place, state)); };
  control.set = [place, name = control.name, lower = control.lower, upper = control.upper, unit = control.unit](
                    ViewState& state, const std::string& text) {
    place(state) = numberIn(name, text, lower, upper, unit);
  };
  return control;
}

Control toggleControl(Control control, const Place<bool>& place) {
  control.kind = Kind::Toggle;
  control.get = [place](const ViewState& state) { return onOff(at(place, state)); };
  control.set = [place, name = control.name](ViewState& state, const std::string& text) {
    place(state) = toggleIn(name, text);
  };
  return control;
}

Control textControl(Control control, const Place<std::string>& place) {
  control.get = [place](const ViewState& state) { return at(place, state); };
  control.set = [place](ViewState& state, const std::string& text) { place(state) = text; };
  return control;
}

// ---- scene, light, camera ----

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

// What --light names without a place: "lamp" of "lamp@1,2,3"; empty where it is a place alone.
std::string lightName(const std::string& text) {
  if (tryVec3(text)) return "";
  const size_t mark = text.rfind('@');
  return mark != std::string::npos && tryVec3(text.substr(mark + 1)) ? text.substr(0, mark) : text;
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
  const auto addOptional = [&](Control control, std::optional<double> SetupOptions::*member) {
    control.kind = Kind::Number;
    control.get = [member](const ViewState& state) {
      const auto& value = state.setup.*member;
      return value ? fmt::format("{}", *value) : std::string();
    };
    control.set = [member, control](ViewState& state, const std::string& text) {
      if (text.empty())
        state.setup.*member = std::nullopt;
      else
        state.setup.*member = numberIn(control.name, text, control.lower, control.upper, control.unit);
    };
    controls.push_back(control);
  };
  addOptional({.name = "cone",
               .label = "cone",
               .group = "Light",
               .sentence = "full angle of a spot's cone; empty: the light's own, else 120",
               .unit = "degrees",
               .lower = 1.0,
               .upper = 180.0,
               .slideLower = 1.0,
               .slideUpper = 180.0},
              &SetupOptions::coneDegrees);
  addOptional({.name = "intensity",
               .label = "intensity",
               .group = "Light",
               .sentence = "candela, or lux of a directional light; empty: the light's own",
               .unit = "cd",
               .lower = 1e-12,
               .upper = 1e12,
               .slideLower = 0.01,
               .slideUpper = 1e5,
               .logarithmic = true},
              &SetupOptions::intensity);
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

// ---- a side's method ----

CompareOptions& optionsOf(ViewState& state, size_t side) {
  return state.sides[side].options;
}
const CompareOptions& optionsOf(const ViewState& state, size_t side) {
  return state.sides[side].options;
}
const Parameterization& mapOf(const ViewState& state, size_t side) {
  return *optionsOf(state, side).maps.front();
}

std::vector<std::string> mapNames() {
  std::vector<std::string> names;
  for (const Parameterization* map : parameterizations()) names.emplace_back(map->name());
  return names;
}

std::vector<std::string> biasNames() {
  std::vector<std::string> names;
  for (const BiasMethod& bias : biasMethods()) names.emplace_back(bias.name);
  return names;
}

std::vector<std::string> filterNames() {
  std::vector<std::string> names;
  for (const Filter& filter : filters()) names.emplace_back(filter.name);
  return names;
}

// A bias of the list, or of a file that the side has; a name that ends in .glsl is read.
void setBias(CompareOptions& options, const std::string& text) {
  if (text.ends_with(".glsl")) {
    std::shared_ptr<const UserBias> user = loadUserBias(text);
    std::erase_if(options.userBiases, [&](const auto& other) { return other->name == user->name; });
    options.userBiases.push_back(user);
    options.biases = {&user->method};
    return;
  }
  for (const auto& user : options.userBiases)
    if (user->name == text) {
      options.biases = {&user->method};
      return;
    }
  options.biases = {&findBias(text)};
}

std::string biasText(const CompareOptions& options) {
  const BiasMethod* bias = options.biases.front();
  for (const auto& user : options.userBiases)
    if (&user->method == bias) return user->path;
  return bias->name;
}

float knobValue(const KnobChoices& choices, const Knob& knob, float sceneScale) {
  for (const KnobValue& value : choices.knobs)
    if (value.knob == &knob) return value.value;
  return knob.defaultFor(sceneScale);
}

void setKnob(KnobChoices& choices, const Knob& knob, float value) {
  for (KnobValue& given : choices.knobs)
    if (given.knob == &knob) {
      given.value = value;
      return;
    }
  choices.knobs.push_back({&knob, value});
}

Control knobControl(const std::string& owner, const Knob& knob, size_t side, const std::string& prefix,
                    const std::string& group, float sceneScale) {
  const float usual = knob.defaultFor(sceneScale);
  const float least = std::min(knob.searchLower * (knob.defaultOfSceneScale ? sceneScale : 1.0f), usual);
  const float most = std::max(knob.searchUpper * (knob.defaultOfSceneScale ? sceneScale : 1.0f), 2.0f * usual);
  Control control{.name = prefix + knobFlag(owner.c_str(), knob).substr(2),
                  .label = knob.name,
                  .group = group,
                  .sentence = knob.sentence,
                  .unit = unitName(knob.unit),
                  .kind = Kind::Number,
                  .lower = static_cast<double>(knob.lower),
                  .upper = static_cast<double>(knob.upper),
                  .slideLower = static_cast<double>(std::max(least, knob.lower)),
                  .slideUpper = static_cast<double>(std::min(most > least ? most : knob.upper, knob.upper)),
                  .logarithmic = knob.defaultOfSceneScale};
  const Knob* const declared = &knob;
  control.get = [side, declared, sceneScale](const ViewState& state) {
    return fmt::format("{}", knobValue(optionsOf(state, side), *declared, sceneScale));
  };
  control.isGiven = [side, declared](const ViewState& state) {
    return std::ranges::any_of(optionsOf(state, side).knobs,
                               [&](const KnobValue& value) { return value.knob == declared; });
  };
  control.set = [side, declared, control](ViewState& state, const std::string& text) {
    setKnob(optionsOf(state, side), *declared,
            static_cast<float>(numberIn(control.name, text, control.lower, control.upper, control.unit)));
  };
  return control;
}

void addMapControls(std::vector<Control>& controls, size_t side, const std::string& prefix, const std::string& group) {
  Control map{.name = prefix + "map",
              .label = "map",
              .group = group,
              .sentence = "the parameterization:",
              .kind = Kind::Choice,
              .choices = mapNames()};
  for (const Parameterization* one : parameterizations())
    map.sentence += fmt::format("\n{}: {}", one->name(), one->sentence());
  map.get = [side](const ViewState& state) { return std::string(mapOf(state, side).name()); };
  map.set = [side, map](ViewState& state, const std::string& text) {
    checkChoice(map.name, text, map.choices);
    optionsOf(state, side).maps = parseMaps(text);
    state.sides[side].mapByLight = false;
    settleOnMap(optionsOf(state, side));
  };
  controls.push_back(map);
  Control size{.name = prefix + "map-size",
               .label = "map size",
               .group = group,
               .sentence = "side of each of the map's square images",
               .unit = "texels",
               .kind = Kind::Whole,
               .lower = 2,
               .upper = 16384,
               .slideLower = 16,
               .slideUpper = 4096,
               .logarithmic = true};
  size.get = [side](const ViewState& state) { return fmt::format("{}", optionsOf(state, side).mapSide); };
  size.set = [side, size](ViewState& state, const std::string& text) {
    optionsOf(state, side).mapSide =
        static_cast<int>(std::lround(numberIn(size.name, text, size.lower, size.upper, size.unit)));
  };
  controls.push_back(size);
  Control cull{.name = prefix + "cull",
               .label = "culling",
               .group = group,
               .sentence =
                   "solids: back faces of closed one-sided meshes, as seen from the light, are left out of the map; "
                   "none: nothing is left out",
               .kind = Kind::Choice,
               .choices = {"solids", "none"}};
  cull.get = [side](const ViewState& state) { return std::string(cullModeName(optionsOf(state, side).cull)); };
  cull.set = [side](ViewState& state, const std::string& text) { optionsOf(state, side).cull = parseCullMode(text); };
  controls.push_back(cull);
  for (const MapOption* option : allMapOptions()) {
    Control control{.name = prefix + option->flag().substr(2),
                    .label = option->flag().substr(2),
                    .group = group,
                    .sentence = option->help(),
                    .choices = option->valueNames()};
    if (!control.choices.empty()) control.kind = Kind::Choice;
    control.get = [side, option](const ViewState& state) {
      const ChosenOption* chosen = optionsOf(state, side).mapOptions.find(*option);
      return chosen == nullptr ? option->defaultText() : option->textOf(chosen->value);
    };
    control.set = [side, option](ViewState& state, const std::string& text) {
      const MapOptions changed = optionsOf(state, side).mapOptions.with({option, option->parsed(text)});
      for (const Parameterization* one : parameterizations()) one->checkOptions(changed);
      optionsOf(state, side).mapOptions = changed;
    };
    control.applies = [side, option](const ViewState& state) {
      const auto own = mapOf(state, side).options();
      const auto volume = volumeParameterization().options();
      return std::ranges::find(own, option) != own.end() ||
             (state.fog.on && std::ranges::find(volume, option) != volume.end());
    };
    controls.push_back(control);
  }
}

void addBiasControls(std::vector<Control>& controls, size_t side, const std::string& prefix, const std::string& group,
                     float sceneScale) {
  const auto isLit = [](const ViewState& state) { return !state.fog.on; };
  Control bias{
      .name = prefix + "bias",
      .label = "bias",
      .group = group,
      .sentence = "what keeps a surface from shadowing itself; a .glsl file dropped on the window is your own:",
      .kind = Kind::Choice,
      .choices = biasNames()};
  for (const BiasMethod& one : biasMethods()) bias.sentence += fmt::format("\n{}: {}", one.name, one.sentence);
  bias.get = [side](const ViewState& state) { return biasText(optionsOf(state, side)); };
  bias.set = [side](ViewState& state, const std::string& text) {
    CompareOptions changed = optionsOf(state, side);
    setBias(changed, text);
    if (!changed.maps.front()->supportsBias(*changed.biases.front()))
      throw UsageError(fmt::format("bias {}: a {} map stores no depths for it", text, changed.maps.front()->name()));
    optionsOf(state, side) = changed;
  };
  bias.applies = isLit;
  controls.push_back(bias);
  for (const BiasMethod& method : biasMethods()) {
    for (const Knob& knob : method.knobs) {
      Control control = knobControl(method.name, knob, side, prefix, group, sceneScale);
      control.applies = [side, declared = &knob](const ViewState& state) {
        return !state.fog.on && hasKnob(*optionsOf(state, side).biases.front(), *declared);
      };
      controls.push_back(control);
    }
  }
  for (const BiasChoice* choice : biasChoices()) {
    Control control{.name = prefix + choice->flag().substr(2),
                    .label = choice->flag().substr(2),
                    .group = group,
                    .sentence = choice->sentence,
                    .kind = Kind::Choice,
                    .choices = {choice->values.begin(), choice->values.end()}};
    control.get = [side, choice](const ViewState& state) {
      return std::string(choice->text(optionsOf(state, side).choices));
    };
    control.set = [side, choice](ViewState& state, const std::string& text) {
      optionsOf(state, side).choices.*choice->member = choice->parse(text);
    };
    control.applies = [side, choice](const ViewState& state) {
      const auto& own = optionsOf(state, side).biases.front()->choices;
      return !state.fog.on && std::ranges::find(own, choice) != own.end();
    };
    controls.push_back(control);
  }
  Control filter{.name = prefix + "filter",
                 .label = "filter",
                 .group = group,
                 .sentence = "percentage-closer filtering:",
                 .kind = Kind::Choice,
                 .choices = filterNames()};
  for (const Filter& one : filters()) filter.sentence += fmt::format("\n{}: {}", one.name, one.sentence);
  filter.get = [side](const ViewState& state) { return std::string(optionsOf(state, side).filters.front()->name); };
  filter.set = [side, filter](ViewState& state, const std::string& text) {
    checkChoice(filter.name, text, filter.choices);
    optionsOf(state, side).filters = parseFilters(text);
  };
  filter.applies = [side](const ViewState& state) { return !state.fog.on && mapOf(state, side).supportsFilters(); };
  controls.push_back(filter);
  for (const Filter& one : filters()) {
    for (const Knob& knob : one.knobs) {
      Control control = knobControl(one.name, knob, side, prefix, group, sceneScale);
      control.applies = [side, declared = &one](const ViewState& state) {
        return !state.fog.on && optionsOf(state, side).filters.front() == declared;
      };
      controls.push_back(control);
    }
  }
}

void addShowControls(std::vector<Control>& controls, size_t side, const std::string& prefix, const std::string& group) {
  Control show{.name = prefix + "show",
               .label = "show",
               .group = group,
               .sentence =
                   "which picture: the scene in this light (beauty), what the map says (visibility), the exact shadow "
                   "(truth), their difference, why pixels are wrong (labels), what the map holds; of fog the "
                   "whole (beauty) or the medium alone",
               .kind = Kind::Choice,
               .choices = picturesToShow()};
  for (const std::string& name : fogPicturesToShow())
    if (std::ranges::find(show.choices, name) == show.choices.end()) show.choices.push_back(name);
  show.get = [side](const ViewState& state) { return state.sides[side].show; };
  show.set = [side, show](ViewState& state, const std::string& text) {
    checkChoice(show.name, text, show.choices);
    state.sides[side].show = text;
  };
  controls.push_back(show);
  const auto isFog = [](const ViewState& state) { return state.fog.on; };
  Control integrator{.name = prefix + "integrator",
                     .label = "integrator",
                     .group = group,
                     .sentence = "how the light along a view ray is summed up:",
                     .kind = Kind::Choice};
  for (const Integrator& one : integrators()) {
    integrator.choices.emplace_back(one.name);
    integrator.sentence += fmt::format("\n{}: {}", one.name, one.says);
  }
  integrator.choices.emplace_back(kReferenceIntegrator);
  integrator.sentence += "\nreference: by ray tracing, refined while nothing moves";
  integrator.get = [side](const ViewState& state) { return state.sides[side].integrator; };
  integrator.set = [side, integrator](ViewState& state, const std::string& text) {
    checkChoice(integrator.name, text, integrator.choices);
    state.sides[side].integrator = text;
  };
  integrator.applies = isFog;
  controls.push_back(integrator);
  Control steps{.name = prefix + "steps",
                .label = "steps",
                .group = group,
                .sentence = "samples along a view ray, of march; in a density, of every integrator",
                .kind = Kind::Whole,
                .lower = 1,
                .upper = 65536,
                .slideLower = 4,
                .slideUpper = 512,
                .logarithmic = true};
  steps.get = [side](const ViewState& state) { return fmt::format("{}", state.sides[side].steps); };
  steps.set = [side, steps](ViewState& state, const std::string& text) {
    state.sides[side].steps = static_cast<int>(std::lround(numberIn(steps.name, text, steps.lower, steps.upper, "")));
  };
  steps.applies = isFog;
  controls.push_back(steps);
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

void addComparison(std::vector<Control>& controls) {
  controls.push_back(
      toggleControl({.name = "split",
                     .label = "split A | B",
                     .group = "Compare",
                     .sentence = "two pictures beside each other; the edge between them is dragged (Tab)"},
                    [](ViewState& state) -> bool& { return state.split; }));
  controls.push_back(numberControl({.name = "split-at",
                                    .label = "edge",
                                    .group = "Compare",
                                    .sentence = "share of the picture's width that shows A",
                                    .slideLower = 0.0,
                                    .slideUpper = 1.0},
                                   [](ViewState& state) -> double& { return state.splitAt; }));
  controls.back().applies = [](const ViewState& state) { return state.split; };
  controls.push_back(
      toggleControl({.name = "loupe",
                     .label = "loupe",
                     .group = "Compare",
                     .sentence = "magnifies the pixels under the cursor and tells which texel decided each, "
                                 "what it holds, and why it is right or wrong (L)"},
                    [](ViewState& state) -> bool& { return state.loupe; }));
  controls.push_back(
      toggleControl({.name = "unfolded",
                     .label = "unfolded map",
                     .group = "Compare",
                     .sentence = "the depths of A's map as its images lie around the light; the cursor marks "
                                 "the texel that decides the pixel under it (M)"},
                    [](ViewState& state) -> bool& { return state.unfolded; }));
}

void addFog(std::vector<Control>& controls, float sceneScale) {
  const auto isFog = [](const ViewState& state) { return state.fog.on; };
  const auto add = [&](const Control& control, double FogState::*member) {
    controls.push_back(numberControl(control, [member](ViewState& state) -> double& { return state.fog.*member; }));
    controls.back().applies = isFog;
  };
  controls.push_back(toggleControl({.name = "fog",
                                    .label = "fog",
                                    .group = "Fog",
                                    .sentence = "light shafts in a medium, by each side's integrator (F)"},
                                   [](ViewState& state) -> bool& { return state.fog.on; }));
  const double usual = kDefaultOpticalDepth / std::max(static_cast<double>(sceneScale), 1e-6);
  add({.name = "fog.sigma-s",
       .label = "scattering",
       .group = "Fog",
       .sentence = "scattering coefficient, at density 1; 0: an optical depth of one half across the scene's diagonal",
       .unit = "1/m",
       .upper = 1e6,
       .slideUpper = 20.0 * usual,
       .logarithmic = true},
      &FogState::sigmaS);
  add({.name = "fog.sigma-a",
       .label = "absorption",
       .group = "Fog",
       .sentence = "absorption coefficient, at density 1",
       .unit = "1/m",
       .upper = 1e6,
       .slideUpper = 20.0 * usual,
       .logarithmic = true},
      &FogState::sigmaA);
  add({.name = "fog.g",
       .label = "g",
       .group = "Fog",
       .sentence = "asymmetry of the Henyey-Greenstein phase function: 1 forward, -1 back",
       .lower = -0.999,
       .upper = 0.999,
       .slideLower = -0.95,
       .slideUpper = 0.95},
      &FogState::g);
  add({.name = "fog.ambient",
       .label = "ambient",
       .group = "Fog",
       .sentence = "radiance of a white surface without any other light",
       .unit = "cd/m^2",
       .upper = 1e9,
       .slideUpper = 100.0},
      &FogState::ambient);
  controls.push_back(
      textControl({.name = "fog.density",
                   .label = "density",
                   .group = "Fog",
                   .sentence = "FILE.vdb[:grid], which may be dropped on the window; empty: the same everywhere"},
                  [](ViewState& state) -> std::string& { return state.fog.density; }));
  controls.back().applies = isFog;
  Control place{.name = "fog.density-at",
                .label = "centre",
                .group = "Fog",
                .sentence = "x,y,z: where the density's centre goes; empty: where the file places it",
                .unit = "m"};
  place.get = [](const ViewState& state) {
    const auto& p = state.fog.densityAt;
    return p ? fmt::format("{},{},{}", p->x, p->y, p->z) : std::string();
  };
  place.set = [](ViewState& state, const std::string& text) {
    state.fog.densityAt = text.empty() ? std::nullopt : std::optional(parsePlace("fog.density-at", text));
  };
  place.applies = isFog;
  controls.push_back(place);
  add({.name = "fog.density-scale",
       .label = "scale",
       .group = "Fog",
       .sentence = "factor of the density's size, about its centre",
       .lower = 1e-6,
       .upper = 1e6,
       .slideLower = 0.1,
       .slideUpper = 10.0,
       .logarithmic = true},
      &FogState::densityScale);
  add({.name = "fog.density-turn",
       .label = "turn",
       .group = "Fog",
       .sentence = "about the density's centre and the y axis",
       .unit = "degrees",
       .lower = -3600.0,
       .upper = 3600.0,
       .slideLower = -180.0,
       .slideUpper = 180.0},
      &FogState::densityTurn);
}

}  // namespace

std::vector<Control> viewControls(const std::shared_ptr<const TracedScene>& traced) {
  const float sceneScale = traced ? computeBounds(traced->scene).diagonal() : 1.0f;
  std::vector<Control> controls;
  addScene(controls);
  addLight(controls, traced);
  addCamera(controls, traced);
  addExposure(controls);
  addComparison(controls);
  for (size_t side = 0; side < kSideCount; ++side) {
    const std::string prefix = side == 0 ? "a." : "b.", group = side == 0 ? "A" : "B";
    addShowControls(controls, side, prefix, group);
    addMapControls(controls, side, prefix, group);
    addBiasControls(controls, side, prefix, group, sceneScale);
  }
  addFog(controls, sceneScale);
  return controls;
}

const Control& findControl(const std::vector<Control>& controls, const std::string& name) {
  const auto found = std::ranges::find(controls, name, &Control::name);
  if (found != controls.end()) return *found;
  std::vector<std::string> names;
  for (const Control& control : controls) names.push_back(control.name);
  const std::string nearest = nearestName(name, names);
  throw UsageError(
      fmt::format("{}: no such control{}", name, nearest.empty() ? "" : "; did you mean " + nearest + "?"));
}

Light lightOf(const ViewState& state, const TracedScene& traced) {
  return chooseLight(state.setup, traced.tracer, mapOf(state, 0));
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

namespace {

constexpr int kSessionVersion = 1;

}  // namespace

std::string sessionJson(const ViewState& state) {
  const std::vector<Control> controls = viewControls(nullptr);
  nlohmann::ordered_json json;
  json["gnomon_view"] = kSessionVersion;
  for (const Control& control : controls) {
    if (!control.derived && control.isGiven(state)) json[control.name] = control.get(state);
  }
  return json.dump(2) + "\n";
}

ViewState readSession(const std::string& path, const std::string& text, const ViewState& others) {
  nlohmann::ordered_json json;
  try {
    json = parseJson<nlohmann::ordered_json>(text, {.depth = 4, .members = 1000});
  } catch (const nlohmann::json::exception&) {
    throw WorldError(path + ": is no JSON; open a session that gnomon view saved");
  }
  if (!json.is_object() || !json.contains("gnomon_view"))
    throw WorldError(path + ": is no session of gnomon view (it has no member gnomon_view)");
  if (json["gnomon_view"] != kSessionVersion)
    throw WorldError(
        fmt::format("{}: is a session of another version of gnomon view; this one reads {}", path, kSessionVersion));
  ViewState state = others;
  const std::vector<Control> controls = viewControls(nullptr);
  for (ViewSide& side : state.sides) side.options.knobs.clear();
  for (const auto& [name, value] : json.items()) {
    if (name == "gnomon_view") continue;
    if (!value.is_string()) throw WorldError(fmt::format("{}: {} is no text", path, name));
    // A map or a bias comes before what only means something with it, as the controls stand in order.
    findControl(controls, name).set(state, value.get<std::string>());
  }
  return state;
}

}  // namespace gnomon
