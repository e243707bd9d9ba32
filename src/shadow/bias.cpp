#include "shadow/bias.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <sstream>

#include <fmt/format.h>

namespace gnomon {

using glsl::BiasParams;

const char* unitName(Unit unit) {
  return unit == Unit::Metres ? "m" : "";
}

const std::vector<BiasMethod>& biasMethods() {
  static const std::vector<BiasMethod> methods = {
      {.id = glsl::kBiasNone, .name = "none", .sentence = "No bias at all (Williams 1978).", .knobs = {}},
      {.id = glsl::kBiasConstant,
       .name = "constant",
       .sentence = "Moves the receiver a fixed distance towards the light (Reeves et al. 1987).",
       .knobs = {{.name = "offset",
                  .unit = Unit::Metres,
                  .lower = 0.0f,
                  .upper = 1e6f,
                  .defaultValue = 2e-3f,
                  .defaultOfSceneScale = true,
                  .sentence = "distance towards the light",
                  .field = &BiasParams::constantOffset}}},
      {.id = glsl::kBiasSlope,
       .name = "slope",
       .sentence = "Scales with the depth change of the receiver's plane across half a texel (King 2004).",
       .knobs = {{.name = "factor",
                  .unit = Unit::One,
                  .lower = 0.0f,
                  .upper = 64.0f,
                  .defaultValue = 2.0f,
                  .defaultOfSceneScale = false,
                  .sentence = "times the plane's depth change across half a texel",
                  .field = &BiasParams::slopeFactor},
                 {.name = "offset",
                  .unit = Unit::Metres,
                  .lower = 0.0f,
                  .upper = 1e6f,
                  .defaultValue = 1e-4f,
                  .defaultOfSceneScale = true,
                  .sentence = "distance towards the light, added",
                  .field = &BiasParams::slopeOffset}}},
      {.id = glsl::kBiasAdaptive,
       .name = "adaptive",
       .sentence = "Compares where the texel's ray meets the receiver's plane (Dou et al. 2014).",
       .knobs = {{.name = "k",
                  .unit = Unit::One,
                  .lower = 0.0f,
                  .upper = 1.0f,
                  .defaultValue = 1e-4f,
                  .defaultOfSceneScale = false,
                  .sentence = "epsilon as a share of the scene's diagonal (the paper's K)",
                  .field = &BiasParams::adaptiveK}}},
  };
  return methods;
}

namespace {

std::string biasNames() {
  std::string names;
  for (const BiasMethod& method : biasMethods())
    names += (names.empty() ? "" : ", ") + std::string(method.name);
  return names;
}

constexpr std::array<const char*, 3> kEpsilonAtNames = {"fragment", "occluder", "stored"};

}  // namespace

const BiasMethod& findBias(const std::string& name) {
  for (const BiasMethod& method : biasMethods())
    if (method.name == name) return method;
  throw UsageError(fmt::format("--biases {}: no such bias; choose from {}", name, biasNames()));
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

BiasParams defaultBiasParams(float sceneScale) {
  BiasParams params{};
  params.epsilonAt = glsl::kEpsilonAtOccluder;
  for (const BiasMethod& method : biasMethods())
    for (const BiasKnob& knob : method.knobs)
      params.*knob.field = knob.defaultValue * (knob.defaultOfSceneScale ? sceneScale : 1.0f);
  return params;
}

int parseEpsilonAt(const std::string& name) {
  for (size_t i = 0; i < kEpsilonAtNames.size(); ++i)
    if (name == kEpsilonAtNames[i]) return static_cast<int>(i);
  throw UsageError(
      fmt::format("--epsilon-at {}: no such place; choose from fragment, occluder, stored", name));
}

const char* epsilonAtName(int epsilonAt) {
  return kEpsilonAtNames[static_cast<size_t>(epsilonAt)];
}

}  // namespace gnomon
