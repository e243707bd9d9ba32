#include "cli/map_flags.h"

#include "base/error.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "lab/core/maps.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

void addCullFlag(CLI::App& verb, MapFlags& flags) {
  offersOneOf(
      verb.add_option("--cull", flags.cull,
                      "solids: back faces of closed one-sided meshes, as seen from the light, are left out of the "
                      "map; none: nothing is left out")
          ->capture_default_str(),
      {"solids", "none"});
}

void addMapOptionFlags(CLI::App& verb, MapFlags& flags, const std::vector<const MapOption*>& options) {
  for (const MapOption* option : options) {
    CLI::Option* flag = verb.add_option_function<std::string>(
                                option->flag(),
                                [&flags, option](const std::string& text) {
                                  flags.options.set({option, option->parsed(text)});
                                },
                                option->help())
                            ->default_str(option->defaultText());
    if (const std::vector<std::string> values = option->valueNames(); !values.empty()) offersOneOf(flag, values);
  }
}

void addMapFlags(CLI::App& verb, MapFlags& flags, const std::string& howMany) {
  const OptionGroup group(verb, "Map");
  std::string maps;
  std::vector<std::string> names;
  for (const Parameterization* map : parameterizations()) {
    maps += fmt::format("{}{} ({})", maps.empty() ? "" : ", ", map->name(), map->sentence());
    names.emplace_back(map->name());
  }
  offersSomeOf(verb.add_option("--maps", flags.maps,
                               howMany + ": " + maps +
                                   "; default: by the light, cube for a point light, spot and directional for theirs"),
               names);
  CLI::Option* side = verb.add_option("--map-size", flags.mapSize, "side of each of the map's square images, texels")
                          ->capture_default_str();
  verb.add_option("--map-texels", flags.mapTexels,
                  "texels of the whole map, all its images together; sets the side of each, so that a cube and a "
                  "paraboloid are compared at equal memory")
      ->excludes(side);
  addCullFlag(verb, flags);
  addMapOptionFlags(verb, flags, allMapOptions());
}

MapChoice mapChoice(const MapFlags& flags) {
  if (flags.mapTexels < 0) throw UsageError(fmt::format("--map-texels {}: must be positive", flags.mapTexels));
  for (const Parameterization* map : parameterizations()) map->checkOptions(flags.options);
  return {.mapSide = flags.mapSize,
          .mapTexels = flags.mapTexels,
          .mapOptions = flags.options,
          .cull = parseCullMode(flags.cull),
          .exposure = flags.exposure};
}

}  // namespace gnomon
