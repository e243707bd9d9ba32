#include "lab/core/method.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

int mapSideOf(const MapChoice& choice, const Parameterization& map) {
  int side = choice.mapSide;
  if (choice.mapTexels != 0) {
    const double each = static_cast<double>(choice.mapTexels) / map.sliceCount(choice.mapOptions);
    side = each >= 0.0 ? static_cast<int>(std::lround(std::min(std::sqrt(each), 1e6))) : 0;
  }
  if (side < 2 || side > 16384)
    throw UsageError(
        fmt::format("a {} map would have images of {} texels a side, outside 2..16384; choose another --map-size or "
                    "--map-texels",
                    map.name(), side));
  return side;
}

MapSetup mapSetupOf(const MapChoice& choice, const Parameterization& map) {
  return {
      .side = mapSideOf(choice, map), .options = choice.mapOptions, .cull = choice.cull, .exposure = choice.exposure};
}

Method methodFor(const SceneView& view, const KnobChoices& choices, const BiasMethod& bias) {
  Method method = atDefaults(bias, view);
  for (const BiasChoice* choice : biasChoices()) method.params.*choice->member = choices.choices.*choice->member;
  for (const auto& [knob, value] : choices.knobs)
    if (hasKnob(bias, *knob)) valueOf(method.params, bias, *knob) = value;
  return method;
}

ChosenFilter filterFor(const KnobChoices& choices, const Filter& filter) {
  ChosenFilter chosen(filter.id);
  for (const auto& [knob, value] : choices.knobs)
    for (size_t i = 0; i < filter.knobs.size(); ++i)
      if (&filter.knobs[i] == knob) chosen.params.knobs[i] = value;
  return chosen;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace gnomon
