#include "shadow/bias.h"

#include "base/check.h"
#include "base/error.h"
#include "base/suggest.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

namespace gnomon {

using glsl::BiasParams;

namespace {

// A knob in metres with a default relative to the scene's diagonal.
Knob metres(const char* name, float share, const char* sentence) {
  return {.name = name,
          .unit = Unit::Metres,
          .lower = 0.0f,
          .upper = 1e6f,
          .defaultValue = share,
          .defaultOfSceneScale = true,
          .sentence = sentence,
          .searchLower = 1e-7f,
          .searchUpper = 1e-1f};
}

}  // namespace

const BiasChoice kEpsilonAt{
    .name = "epsilon_at",
    .sentence =
        "where adaptive evaluates its epsilon: fragment (the paper's text), occluder (its Algorithm 1) or stored (its "
        "listings)",
    .member = &BiasParams::epsilonAt,
    .values = {"occluder", "fragment", "stored"},
    .numbers = {glsl::kEpsilonAtOccluder, glsl::kEpsilonAtFragment, glsl::kEpsilonAtStored}};
const BiasChoice kWitnessReach{.name = "witness_reach",
                               .sentence =
                                   "texels a side around the receiver that witness asks: 2, or where those have "
                                   "no witness 4",
                               .member = &BiasParams::witnessReach,
                               .values = {"2", "4"},
                               .numbers = {2, 4}};
const BiasChoice kPriorityId{.name = "priority_id",
                             .sentence =
                                 "whose number the priority buffers compare: the triangle's, the instance's or "
                                 "the connected surface's (sheet)",
                             .member = &BiasParams::priorityId,
                             .values = {"triangle", "instance", "sheet"},
                             .numbers = {glsl::kPriorityTriangle, glsl::kPriorityInstance, glsl::kPrioritySheet}};

const std::vector<const BiasChoice*>& biasChoices() {
  static const std::vector<const BiasChoice*> all = {&kEpsilonAt, &kWitnessReach, &kPriorityId};
  return all;
}

std::string BiasChoice::flag() const {
  std::string flag = fmt::format("--{}", name);
  std::ranges::replace(flag, '_', '-');
  return flag;
}

const char* BiasChoice::text(const BiasParams& params) const {
  const auto found = std::ranges::find(numbers, params.*member);
  GNOMON_CHECK(found != numbers.end());
  return values[static_cast<size_t>(found - numbers.begin())];
}

int BiasChoice::parse(const std::string& text) const {
  std::string choices;
  for (size_t i = 0; i < values.size(); ++i) {
    if (text == values[i]) return numbers[i];
    choices += (choices.empty() ? "" : ", ") + std::string(values[i]);
  }
  throw UsageError(fmt::format("{} {}: {}", flag(), text, chooseFrom(text, choices)));
}

BiasParams defaultChoices() {
  BiasParams params{};
  for (const BiasChoice* choice : biasChoices()) params.*choice->member = choice->numbers.front();
  return params;
}

const std::vector<BiasMethod>& biasMethods() {
  static const std::vector<BiasMethod> methods = {
      {.id = glsl::kBiasNone,
       .name = "none",
       .sentence = "No bias at all (Williams 1978).",
       .knobs = {},
       .onVolumes = true},
      {.id = glsl::kBiasConstant,
       .name = "constant",
       .sentence = "Adds a world-space offset to the stored depth (Reeves et al. 1987).",
       .knobs = {metres("offset", 2e-3f, "offset along the texel's ray")},
       .onVolumes = true},
      {.id = glsl::kBiasSlope,
       .name = "slope",
       .sentence = "Scales with the depth change of the receiver's plane across half a texel (King 2004).",
       .knobs = {{.name = "factor",
                  .unit = Unit::One,
                  .lower = 0.0f,
                  .upper = 64.0f,
                  .defaultValue = 2.0f,
                  .defaultOfSceneScale = false,
                  .sentence = "factor of the receiver plane's depth change across half a texel",
                  .searchLower = 1e-2f,
                  .searchUpper = 64.0f},
                 metres("offset", 1e-4f, "constant offset, added")}},
      {.id = glsl::kBiasNormalOffset,
       .name = "normal-offset",
       .sentence = "Moves the receiver along its normal before the lookup (Holbert 2011).",
       .knobs = {{.name = "texels",
                  .unit = Unit::Texels,
                  .lower = 0.0f,
                  .upper = 64.0f,
                  .defaultValue = 1.5f,
                  .defaultOfSceneScale = false,
                  .sentence = "distance along the normal, scaled by the sine of its angle to the light",
                  .searchLower = 1e-2f,
                  .searchUpper = 64.0f}}},
      {.id = glsl::kBiasCosine,
       .name = "cosine",
       .sentence = "A constant, weighted by the angle between normal and light (Gautron et al. 2013).",
       .knobs = {metres("offset", 4e-3f, "offset where the surface is edge-on to the light")}},
      {.id = glsl::kBiasReceiverPlane,
       .name = "receiver-plane",
       .sentence = "Extrapolates the receiver's depth to the tap along its plane's gradient (Isidoro 2006).",
       .knobs = {metres("offset", 1e-4f, "constant offset, added")}},
      {.id = glsl::kBiasSecondDepth,
       .name = "second-depth",
       .sentence = "Stores the back faces of solids (Wang & Molnar 1994).",
       .knobs = {metres("offset", 1e-4f, "offset, for sheets and for solids in contact")},
       .channels = glsl::kChannelBackDepth},
      {.id = glsl::kBiasMidpoint,
       .name = "midpoint",
       .sentence = "Halfway between the two nearest depth layers (Woo 1992).",
       .knobs = {},
       .channels = glsl::kChannelDepth | glsl::kChannelSecondDepth},
      {.id = glsl::kBiasDual,
       .name = "dual",
       .sentence = "Halfway between the two nearest depth layers, but at most the offset (Weiskopf & Ertl 2003).",
       .knobs = {metres("offset", 1e-2f, "maximum of the bias")},
       .channels = glsl::kChannelDepth | glsl::kChannelSecondDepth},
      {.id = glsl::kBiasAdaptive,
       .name = "adaptive",
       .sentence = "Compares where the texel's ray meets the receiver's plane (Dou et al. 2014).",
       .knobs = {{.name = "k",
                  .unit = Unit::One,
                  .lower = 0.0f,
                  .upper = 1.0f,
                  .defaultValue = 1e-4f,
                  .defaultOfSceneScale = false,
                  .sentence =
                      "epsilon as a fraction of the scene's diagonal (the paper's K), for all three adaptive biases",
                  .searchLower = 1e-7f,
                  .searchUpper = 1e-1f}},
       .choices = {&kEpsilonAt},
       .onVolumes = true},
      {.id = glsl::kBiasAdaptiveClamped,
       .name = "adaptive-clamped",
       .sentence = "adaptive, clamped so as not to lie behind the receiver (the authors' shaders).",
       .knobs = {},
       .sharesKnobsWith = "adaptive",
       .choices = {&kEpsilonAt}},
      {.id = glsl::kBiasAdaptiveEhm,
       .name = "adaptive-ehm",
       .sentence = "adaptive, with an epsilon that grows at grazing angles (Ehm et al. 2015).",
       .knobs = {},
       .sharesKnobsWith = "adaptive",
       .choices = {&kEpsilonAt}},
      {.id = glsl::kBiasEevee,
       .name = "eevee",
       .sentence = "Along the normal by a texel's radius, and a texel's slope (Blender's EEVEE).",
       .knobs = {}},
      {.id = glsl::kBiasGodot,
       .name = "godot",
       .sentence = "Along the normal by texels, and a fixed distance of depth (Godot 4's defaults).",
       .knobs = {}},
      {.id = glsl::kBiasBevy,
       .name = "bevy",
       .sentence = "Along the normal by texels, and towards the light by centimetres (Bevy's defaults).",
       .knobs = {}},
      {.id = glsl::kBiasUnrealVsm,
       .name = "unreal-vsm",
       .sentence = "Twice the receiver plane's change to the texel, towards the light (Unreal 5's virtual maps).",
       .knobs = {}},
      {.id = glsl::kBiasPriorityBuffer,
       .name = "priority-buffer",
       .sentence = "Lit where the texel holds the receiver's own number (Hourcade & Nicolas 1985).",
       .knobs = {},
       .channels = glsl::kChannelDepth | glsl::kChannelIds,
       .choices = {&kPriorityId}},
      {.id = glsl::kBiasPriorityDepth,
       .name = "priority-depth",
       .sentence = "priority-buffer, and depth without a bias where the numbers differ.",
       .knobs = {},
       .channels = glsl::kChannelDepth | glsl::kChannelIds,
       .choices = {&kPriorityId}},
      {.id = glsl::kBiasTwoPlaneDepth,
       .name = "two-plane-depth",
       .sentence = "Lit where the receiver's plane or one of four planes through neighbouring depths says so.",
       .knobs = {}},
      {.id = glsl::kBiasTwoPlane,
       .name = "two-plane",
       .sentence = "Lit where the receiver's plane or that of the triangle the texel names says so.",
       .knobs = {},
       .channels = glsl::kChannelDepth | glsl::kChannelIds},
      {.id = glsl::kBiasWitness,
       .name = "witness",
       .sentence = "In shadow where a named triangle's surface, followed to the receiver, stands before it.",
       .knobs = {},
       .channels = glsl::kChannelDepth | glsl::kChannelIds,
       .choices = {&kWitnessReach}},
  };
  return methods;
}

namespace {

std::string biasNames() {
  std::string names;
  for (const BiasMethod& method : biasMethods()) names += (names.empty() ? "" : ", ") + std::string(method.name);
  return names;
}

}  // namespace

const std::vector<Knob>& knobsOf(const BiasMethod& method) {
  return method.sharesKnobsWith != nullptr ? findBias(method.sharesKnobsWith).knobs : method.knobs;
}

const BiasMethod& findBias(const std::string& name) {
  for (const BiasMethod& method : biasMethods())
    if (method.name == name) return method;
  throw UsageError(fmt::format("--biases {}: no such bias; {}", name, chooseFrom(name, biasNames())));
}

std::vector<const BiasMethod*> parseBiases(const std::string& list) {
  std::vector<const BiasMethod*> chosen;
  if (list == "all") {
    for (const BiasMethod& method : biasMethods()) chosen.push_back(&method);
    return chosen;
  }
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    const BiasMethod* method = &findBias(word);
    if (std::ranges::find(chosen, method) == chosen.end()) chosen.push_back(method);
  }
  if (chosen.empty()) throw UsageError(fmt::format("--biases is empty; choose from {}", biasNames()));
  return chosen;
}

BiasParams defaultBiasParams(const BiasMethod& method, float sceneScale) {
  BiasParams params = defaultChoices();
  for (const Knob& knob : knobsOf(method)) valueOf(params, method, knob) = knob.defaultFor(sceneScale);
  return params;
}

bool hasKnob(const BiasMethod& method, const Knob& knob) {
  return std::ranges::any_of(knobsOf(method), [&](const Knob& own) { return &own == &knob; });
}

float& valueOf(BiasParams& params, const BiasMethod& method, const Knob& knob) {
  GNOMON_CHECK(hasKnob(method, knob));
  const auto place = &knob - knobsOf(method).data();
  GNOMON_CHECK_LT(place, glsl::kMostKnobs);
  return params.knobs[place];
}

float valueOf(const BiasParams& params, const BiasMethod& method, const Knob& knob) {
  BiasParams copy = params;
  return valueOf(copy, method, knob);
}

}  // namespace gnomon
