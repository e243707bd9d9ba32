#include "view/view_controls.h"

#include "base/error.h"
#include "base/parse.h"
#include "base/suggest.h"
#include "view/control_kinds.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

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
  controls.push_back(
      toggleControl({.name = "second-layer",
                     .label = "its second layer",
                     .group = "Compare",
                     .sentence = "of the unfolded map: the depths behind the first, where the bias of A stores them"},
                    [](ViewState& state) -> bool& { return state.secondLayer; }));
  controls.back().applies = [](const ViewState& state) { return state.unfolded; };
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
  controls.push_back(optionalControl(
      {.name = "fog.sigma-s",
       .label = "scattering",
       .group = "Fog",
       .sentence =
           "scattering coefficient, at density 1; empty: an optical depth of one half across the scene's diagonal",
       .unit = "1/m",
       .upper = 1e6,
       .slideUpper = 20.0 * usual,
       .logarithmic = true},
      [](ViewState& state) -> std::optional<double>& { return state.fog.sigmaS; }));
  controls.back().applies = isFog;
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

std::vector<Control> viewControls(const std::shared_ptr<const TracedScene>& traced, const ViewState& state) {
  const float sceneScale = traced ? computeBounds(traced->scene).diagonal() : 1.0f;
  std::vector<Control> controls;
  addScene(controls);
  addLight(controls, traced);
  addCamera(controls, traced);
  addExposure(controls);
  addComparison(controls);
  for (size_t side = 0; side < kSideCount; ++side) addSide(controls, side, sceneScale, state);
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

}  // namespace gnomon
