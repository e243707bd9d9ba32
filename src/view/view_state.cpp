#include "view/view_state.h"

#include "base/parse.h"
#include "lab/compare/compare_command.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

SetupOptions sized(const SetupOptions& setup, int width, int height) {
  SetupOptions own = setup;
  own.size = width == height ? fmt::format("{}", width) : fmt::format("{}x{}", width, height);
  return own;
}

CompareOptions withoutOthers(const CompareOptions& options) {
  CompareOptions own = options;
  // A bias file that is not drawn with is not named.
  std::erase_if(own.userBiases, [&](const auto& user) { return &user->method != own.biases.front(); });
  return own;
}

std::string fogCommand(const ViewState& state, int side, const SetupOptions& setup, const std::string& file) {
  const ViewSide& drawn = state.sides[static_cast<size_t>(side)];
  const CompareOptions& options = drawn.options;
  const FogState& fog = state.fog;
  std::string line = "gnomon fog";
  const auto word = [&](const std::string& text) { line += " " + shellWord(text); };
  const auto flag = [&](const char* name, const auto& value) {
    word(name);
    word(fmt::format("{}", value));
  };
  for (const std::string& text : setupWords(setup)) word(text);
  if (fog.sigmaS) flag("--sigma-s", *fog.sigmaS);
  if (fog.sigmaA > 0.0) flag("--sigma-a", fog.sigmaA);
  if (fog.g != FogState().g) flag("--g", fog.g);
  if (fog.ambient > 0.0) flag("--ambient", fog.ambient);
  if (!fog.density.empty()) {
    flag("--density", fog.density);
    if (fog.densityAt)
      flag("--density-at", fmt::format("{},{},{}", fog.densityAt->x, fog.densityAt->y, fog.densityAt->z));
    if (fog.densityScale != 1.0) flag("--density-scale", fog.densityScale);
    if (fog.densityTurn != 0.0) flag("--density-turn", fog.densityTurn);
  }
  if (drawn.integrator == kReferenceIntegrator) {
    word("--truth");
  } else {
    flag("--integrators", drawn.integrator);
    if (findIntegrator(drawn.integrator).takesSteps || !fog.density.empty()) flag("--steps", drawn.steps);
  }
  if (options.maps.front()->looksAround() && options.maps.front()->name() != std::string("cube"))
    flag("--march-map", options.maps.front()->name());
  if (options.mapSide != CompareOptions().mapSide) flag("--map-size", options.mapSide);
  for (const ChosenOption& choice : options.mapOptions.choices()) {
    const auto own = volumeParameterization().options();
    if (std::ranges::find(own, choice.option) != own.end())
      flag(choice.option->flag().c_str(), choice.option->textOf(choice.value));
  }
  if (options.cull != CompareOptions().cull) flag("--cull", cullModeName(options.cull));
  if (options.exposure) flag("--exposure", *options.exposure);
  if (drawn.show == "medium") flag("--show", drawn.show);
  flag("-o", file);
  return line;
}

}  // namespace

void settleOnMap(CompareOptions& options) {
  const Parameterization& map = *options.maps.front();
  if (!map.supportsBias(*options.biases.front())) options.biases = {&findBias("adaptive")};
  if (!map.supportsFilters()) options.filters = {&filters().front()};
}

void chooseMapsByLight(ViewState& state, const Tracer& tracer) {
  for (ViewSide& side : state.sides) {
    if (!side.mapByLight) continue;
    side.options.maps = {&usualMapOf(state.setup, tracer, side.options.mapOptions)};
    settleOnMap(side.options);
  }
}

ViewState initialState(const SetupOptions& setup, const CompareOptions& options) {
  ViewState state{.setup = setup};
  for (ViewSide& side : state.sides) side.options = options;
  return state;
}

std::string pictureCommand(const ViewState& state, int side, int width, int height, const std::string& file) {
  const SetupOptions setup = sized(state.setup, width, height);
  if (state.fog.on) return fogCommand(state, side, setup, file);
  const ViewSide& drawn = state.sides[static_cast<size_t>(side)];
  return renderCommand(setup, withoutOthers(drawn.options), drawn.show, file);
}

std::string comparisonCommand(const ViewState& state, int width, int height) {
  CompareOptions options = withoutOthers(state.sides[0].options);
  const CompareOptions& other = state.sides[1].options;
  // What can stand in one table: another map, bias or filter, with the parameters of both.
  if (state.split) {
    const auto add = [](auto& list, auto item) {
      if (std::ranges::find(list, item) == list.end()) list.push_back(item);
    };
    add(options.maps, other.maps.front());
    add(options.biases, other.biases.front());
    add(options.filters, other.filters.front());
    for (const KnobValue& value : other.knobs)
      if (std::ranges::none_of(options.knobs, [&](const KnobValue& own) { return own.knob == value.knob; }))
        options.knobs.push_back(value);
    for (const auto& user : other.userBiases)
      if (&user->method == other.biases.front()) add(options.userBiases, user);
  }
  return compareCommand(sized(state.setup, width, height), options);
}

FogMedium fogMediumOf(const FogState& fog, const glm::dvec3& originW) {
  FogMedium medium{.sigmaA = glm::vec3(static_cast<float>(fog.sigmaA)),
                   .g = static_cast<float>(fog.g),
                   .ambient = static_cast<float>(fog.ambient)};
  if (fog.sigmaS) medium.sigmaS = glm::vec3(static_cast<float>(*fog.sigmaS));
  if (!fog.density.empty())
    medium.density = std::make_shared<const DensityGrid>(
        fog.density,
        DensityPlacement{
            .scale = fog.densityScale, .turnDegrees = fog.densityTurn, .centerW = fog.densityAt, .originW = originW});
  return medium;
}

}  // namespace gnomon
