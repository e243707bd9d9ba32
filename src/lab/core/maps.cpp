#include "lab/core/maps.h"

#include "base/error.h"
#include "base/suggest.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "planar/planar_map.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

namespace gnomon {

const std::vector<const Parameterization*>& parameterizations() {
  static const std::vector<const Parameterization*> all = [] {
    std::vector<const Parameterization*> maps = planarParameterizations();
    maps.push_back(&cubeParameterization());
    maps.push_back(&paraboloidParameterization());
    maps.push_back(&volumeParameterization());
    return maps;
  }();
  return all;
}

const std::vector<const MapOption*>& allMapOptions() {
  static const std::vector<const MapOption*> all = [] {
    std::vector<const MapOption*> options;
    for (const Parameterization* map : parameterizations())
      for (const MapOption* option : map->options())
        if (std::ranges::find(options, option) == options.end()) options.push_back(option);
    return options;
  }();
  return all;
}

std::vector<const Parameterization*> parseMaps(const std::string& list) {
  std::string names;
  for (const Parameterization* p : parameterizations()) names += (names.empty() ? "" : ", ") + std::string(p->name());
  std::vector<const Parameterization*> chosen;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    const auto found =
        std::ranges::find_if(parameterizations(), [&](const Parameterization* p) { return p->name() == word; });
    if (found == parameterizations().end())
      throw UsageError(fmt::format("--maps {}: no such map; {}", word, chooseFrom(word, names)));
    if (std::ranges::find(chosen, *found) == chosen.end()) chosen.push_back(*found);
  }
  if (chosen.empty()) throw UsageError(fmt::format("--maps is empty; choose from {}", names));
  return chosen;
}

const Parameterization& usualMapFor(LightType type, const MapOptions& options) {
  std::vector<const Parameterization*> maps = {&spotParameterization()};
  if (type == LightType::Point)
    maps = {&cubeParameterization(), &spotParameterization(), &paraboloidParameterization()};
  if (type == LightType::Directional) maps = {&directionalParameterization()};
  const auto hasAll = [&](const Parameterization* map) {
    const std::vector<const MapOption*> own = map->options();
    return std::ranges::all_of(options.choices(), [&](const ChosenOption& choice) {
      return std::ranges::find(own, choice.option) != own.end();
    });
  };
  const auto found = std::ranges::find_if(maps, hasAll);
  const Parameterization* chosen = found == maps.end() ? maps.front() : *found;
  return *chosen;
}

}  // namespace gnomon
