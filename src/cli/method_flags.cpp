#include "cli/method_flags.h"

#include "base/error.h"
#include "cli/unused_flags.h"
#include "lab/core/maps.h"
#include "planar/planar_map.h"
#include "planar/warp.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

// What means nothing on a map is left out there, and said so; where nothing is left, refused.
void checkMeaning(const CompareOptions& options, const Parameterization& map) {
  const CompareOptions own = optionsFor(options, map);
  std::string biases, left;
  for (const BiasMethod& method : biasMethods())
    if (map.supportsBias(method)) biases += (biases.empty() ? "" : ", ") + std::string(method.name);
  if (own.biases.empty())
    throw UsageError(fmt::format("--maps {} supports none of these --biases; choose from {}", map.name(), biases));
  if (own.filters.empty())
    throw UsageError(fmt::format("--maps {} supports no filter; add --filters none", map.name()));
  for (const BiasMethod* bias : options.biases)
    if (std::ranges::find(own.biases, bias) == own.biases.end())
      left += (left.empty() ? "" : ", ") + std::string(bias->name);
  for (const Filter* filter : options.filters)
    if (std::ranges::find(own.filters, filter) == own.filters.end())
      left += (left.empty() ? "" : ", ") + std::string(filter->name);
  if (!left.empty()) fmt::print(stderr, "gnomon: {} stores no depths, so it skips {}\n", map.name(), left);
}

template <typename T, typename U>
bool isIn(const std::vector<T>& list, U one) {
  return std::ranges::find(list, one) != list.end();
}

// Each parameter and option says what it belongs to.
void tellUnusedFlags(const CLI::App& verb, const CompareOptions& options) {
  UnusedFlags unused(verb);
  for (const BiasMethod& method : biasMethods()) {
    const bool isUsed = std::ranges::any_of(options.biases, [&](const BiasMethod* bias) {
      return bias->name == std::string_view(method.name) ||
             (bias->sharesKnobsWith != nullptr && bias->sharesKnobsWith == std::string_view(method.name));
    });
    for (const Knob& knob : method.knobs)
      unused.tellUnless(isUsed, knobFlag(method.name, knob), fmt::format("{} is not among --biases", method.name));
  }
  for (const Filter& filter : filters())
    for (const Knob& knob : filter.knobs)
      unused.tellUnless(isIn(options.filters, &filter), knobFlag(filter.name, knob),
                        fmt::format("{} is not among --filters", filter.name));
  for (const BiasChoice* choice : biasChoices())
    unused.tellUnless(
        std::ranges::any_of(options.biases, [&](const BiasMethod* bias) { return isIn(bias->choices, choice); }),
        choice->flag(), "none of the --biases has this choice");
  std::string maps;
  for (const Parameterization* map : options.maps) maps += (maps.empty() ? "" : ", ") + std::string(map->name());
  for (const MapOption* option : allMapOptions())
    unused.tellUnless(
        std::ranges::any_of(options.maps, [&](const Parameterization* map) { return isIn(map->options(), option); }),
        option->flag(), fmt::format("the map {} has no such option", maps));
  const bool mayWarp =
      std::ranges::any_of(options.maps, [](const Parameterization* map) { return isIn(map->options(), &kSnap); });
  unused.tellUnless(!mayWarp || options.mapOptions.get(kWarp) == Warp::None, kSnap.flag(), "warped maps cannot snap");
}

}  // namespace

void addMethodFlags(CLI::App& verb, MethodFlags& flags, const char* defaultBiases, const std::string& mapsTaken,
                    const std::string& biasesTaken) {
  flags.verb = &verb;
  addMapFlags(verb, flags.map, mapsTaken);
  addBiasFlags(verb, flags.bias, defaultBiases, biasesTaken);
}

CompareOptions compareOptions(const MethodFlags& flags) {
  CompareOptions options;
  static_cast<MapChoice&>(options) = mapChoice(flags.map);
  options.maps = flags.map.maps.empty() ? std::vector{&usualMapFor(LightType::Point, options.mapOptions)}
                                        : parseMaps(flags.map.maps);
  for (const Parameterization* map : options.maps) mapSideOf(options, *map);
  chooseBiases(flags.bias, options);
  for (const Parameterization* map : options.maps) checkMeaning(options, *map);
  return options;
}

void chooseUsualMap(const MethodFlags& flags, const Session& session, CompareOptions& options) {
  if (flags.map.maps.empty()) {
    options.maps = {&usualMapOf(session.setup(), session.tracer(), options.mapOptions)};
    mapSideOf(options, *options.maps.front());
  }
  tellUnusedFlags(*flags.verb, options);
}

}  // namespace gnomon
