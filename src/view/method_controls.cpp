// What a side shows: map, bias, filter and their parameters, from the lists that declare them.

#include "base/error.h"
#include "lab/compare/render_picture.h"
#include "lab/core/maps.h"
#include "lab/fog/fog_pictures.h"
#include "shadow/user_bias_check.h"
#include "view/control_kinds.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

using Kind = Control::Kind;

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

const Knob* knobNamed(const BiasMethod& method, std::string_view name) {
  const auto found = std::ranges::find_if(method.knobs, [&](const Knob& knob) { return name == knob.name; });
  return found == method.knobs.end() ? nullptr : &*found;
}

// What was set of a file's parameters is set of those of the same names in the file as it is now.
void takeKnobs(KnobChoices& choices, const BiasMethod& before, const BiasMethod& now) {
  std::vector<KnobValue> kept;
  for (const KnobValue& given : choices.knobs) {
    const bool isOld = std::ranges::any_of(before.knobs, [&](const Knob& knob) { return &knob == given.knob; });
    const Knob* knob = isOld ? knobNamed(now, given.knob->name) : given.knob;
    if (knob != nullptr && given.value >= knob->lower && given.value <= knob->upper)
      kept.push_back({knob, given.value});
  }
  choices.knobs = std::move(kept);
}

// A bias of the list, or of a file that the side has; a name that ends in .glsl is read.
void setBias(CompareOptions& options, const std::string& text, const std::string& control) {
  if (text.ends_with(".glsl")) {
    checkNoStream(text);
    std::shared_ptr<const UserBias> user = loadUserBias(text);
    const auto isKnown = [&](const auto& other) { return other->path == user->path && other->source == user->source; };
    if (const auto known = std::ranges::find_if(options.userBiases, isKnown); known != options.userBiases.end()) {
      options.biases = {&(*known)->method};
      return;
    }
    checkUserBias(*user);
    for (const auto& other : options.userBiases)
      if (other->name == user->name) takeKnobs(options, other->method, user->method);
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
  checkChoice(control, text, biasNames());
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

Control knobControl(const std::string& name, const Knob& knob, size_t side, const std::string& group,
                    float sceneScale) {
  const float usual = knob.defaultFor(sceneScale);
  const float least = std::min(knob.searchLower * (knob.defaultOfSceneScale ? sceneScale : 1.0f), usual);
  const float most = std::max(knob.searchUpper * (knob.defaultOfSceneScale ? sceneScale : 1.0f), 2.0f * usual);
  Control control{.name = name,
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

// "a.constant-offset"
std::string knobControlName(const std::string& prefix, const char* owner, const Knob& knob) {
  return prefix + knobFlag(owner, knob).substr(2);
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

// Of the bias file that is chosen.
void addUserKnobs(std::vector<Control>& controls, size_t side, const std::string& prefix, const std::string& group,
                  float sceneScale, const CompareOptions& options) {
  for (const std::shared_ptr<const UserBias>& user : options.userBiases) {
    if (&user->method != options.biases.front()) continue;
    for (const Knob& knob : user->method.knobs) {
      Control control = knobControl(prefix + "knob." + knob.name, knob, side, group, sceneScale);
      if (control.sentence.empty()) control.sentence = "parameter of " + user->path;
      // It lives as long as its control.
      control.applies = [side, user](const ViewState& state) {
        return !state.fog.on && optionsOf(state, side).biases.front() == &user->method;
      };
      controls.push_back(control);
    }
  }
}

void addBiasControls(std::vector<Control>& controls, size_t side, const std::string& prefix, const std::string& group,
                     float sceneScale, const CompareOptions& options) {
  const auto isLit = [](const ViewState& state) { return !state.fog.on; };
  Control bias{
      .name = prefix + "bias",
      .label = "bias",
      .group = group,
      .sentence = "what keeps a surface from shadowing itself; a .glsl file dropped on the window is your own:",
      .kind = Kind::Choice,
      .choices = biasNames()};
  for (const BiasMethod& one : biasMethods()) bias.sentence += fmt::format("\n{}: {}", one.name, one.sentence);
  for (const std::shared_ptr<const UserBias>& user : options.userBiases) bias.choices.push_back(user->path);
  bias.get = [side](const ViewState& state) { return biasText(optionsOf(state, side)); };
  bias.set = [side, name = bias.name](ViewState& state, const std::string& text) {
    CompareOptions changed = optionsOf(state, side);
    setBias(changed, text, name);
    if (!changed.maps.front()->supportsBias(*changed.biases.front()))
      throw UsageError(fmt::format("bias {}: a {} map stores no depths for it", text, changed.maps.front()->name()));
    optionsOf(state, side) = changed;
  };
  bias.applies = isLit;
  controls.push_back(bias);
  for (const BiasMethod& method : biasMethods()) {
    for (const Knob& knob : method.knobs) {
      Control control = knobControl(knobControlName(prefix, method.name, knob), knob, side, group, sceneScale);
      control.applies = [side, declared = &knob](const ViewState& state) {
        return !state.fog.on && hasKnob(*optionsOf(state, side).biases.front(), *declared);
      };
      controls.push_back(control);
    }
  }
  addUserKnobs(controls, side, prefix, group, sceneScale, options);
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
    const std::vector<const Filter*> chosen = parseFilters(text);
    if (!mapOf(state, side).supportsFilters() && chosen.front() != &filters().front())
      throw UsageError(fmt::format("filter {}: a {} map stores no depths for it", text, mapOf(state, side).name()));
    optionsOf(state, side).filters = chosen;
  };
  filter.applies = [side](const ViewState& state) { return !state.fog.on && mapOf(state, side).supportsFilters(); };
  controls.push_back(filter);
  for (const Filter& one : filters()) {
    for (const Knob& knob : one.knobs) {
      Control control = knobControl(knobControlName(prefix, one.name, knob), knob, side, group, sceneScale);
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

}  // namespace

std::array<uint64_t, kSideCount> chosenBiasFiles(const ViewState& state) {
  std::array<uint64_t, kSideCount> numbers{};
  for (size_t side = 0; side < kSideCount; ++side)
    for (const auto& user : optionsOf(state, side).userBiases)
      if (&user->method == optionsOf(state, side).biases.front()) numbers[side] = user->number;
  return numbers;
}

void addSide(std::vector<Control>& controls, size_t side, float sceneScale, const ViewState& state) {
  const std::string prefix = side == 0 ? "a." : "b.", group = side == 0 ? "A" : "B";
  addShowControls(controls, side, prefix, group);
  addMapControls(controls, side, prefix, group);
  addBiasControls(controls, side, prefix, group, sceneScale, optionsOf(state, side));
}

}  // namespace gnomon
