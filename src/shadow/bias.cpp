#include "shadow/bias.h"

#include "base/check.h"
#include "base/error.h"
#include "base/suggest.h"

#include <algorithm>
#include <array>
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
       .takesEpsilonAt = true,
       .onVolumes = true},
      {.id = glsl::kBiasAdaptiveClamped,
       .name = "adaptive-clamped",
       .sentence = "adaptive, clamped so as not to lie behind the receiver (the authors' shaders).",
       .knobs = {},
       .sharesKnobsWith = "adaptive",
       .takesEpsilonAt = true},
      {.id = glsl::kBiasAdaptiveEhm,
       .name = "adaptive-ehm",
       .sentence = "adaptive, with an epsilon that grows at grazing angles (Ehm et al. 2015).",
       .knobs = {},
       .sharesKnobsWith = "adaptive",
       .takesEpsilonAt = true},
      {.id = glsl::kBiasEevee,
       .name = "eevee",
       .sentence = "Along the normal by a texel's radius, and a texel's slope (Blender's EEVEE).",
       .knobs = {}},
      {.id = glsl::kBiasGodot,
       .name = "godot",
       .sentence = "Along the normal by a texel, and 1% of the map's depth (Godot 4's defaults).",
       .knobs = {}},
      {.id = glsl::kBiasBevy,
       .name = "bevy",
       .sentence = "Along the normal by texels, and towards the light by centimetres (Bevy's defaults).",
       .knobs = {}},
      {.id = glsl::kBiasUnrealVsm,
       .name = "unreal-vsm",
       .sentence = "Twice the receiver plane's change to the texel, towards the light (Unreal 5's virtual maps).",
       .knobs = {}},
  };
  return methods;
}

namespace {

std::string biasNames() {
  std::string names;
  for (const BiasMethod& method : biasMethods()) names += (names.empty() ? "" : ", ") + std::string(method.name);
  return names;
}

constexpr std::array<const char*, 3> kEpsilonAtNames = {"fragment", "occluder", "stored"};

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
  BiasParams params{.epsilonAt = glsl::kEpsilonAtOccluder};
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

int parseEpsilonAt(const std::string& name) {
  for (size_t i = 0; i < kEpsilonAtNames.size(); ++i)
    if (name == kEpsilonAtNames[i]) return static_cast<int>(i);
  throw UsageError(fmt::format("--epsilon-at {}: {}", name, chooseFrom(name, "fragment, occluder, stored")));
}

const char* epsilonAtName(int epsilonAt) {
  return kEpsilonAtNames[static_cast<size_t>(epsilonAt)];
}

}  // namespace gnomon
