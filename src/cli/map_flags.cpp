#include "cli/map_flags.h"

#include "base/error.h"
#include "lab/core/maps.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

void addCullFlag(CLI::App& verb, MapFlags& flags) {
  verb.add_option("--cull", flags.cull,
                  "solids: closed one-sided meshes cast by their lit faces only; none: everything casts")
      ->capture_default_str();
}

void addMapOptionFlags(CLI::App& verb, MapFlags& flags, const std::vector<const MapOption*>& options) {
  for (const MapOption* option : options)
    verb.add_option_function<std::string>(
            option->flag(),
            [&flags, option](const std::string& text) {
              flags.options.set({option, option->parsed(text)});
            },
            option->help())
        ->default_str(option->defaultText());
}

void addMapFlags(CLI::App& verb, MapFlags& flags, const char* defaultMaps) {
  flags.maps = defaultMaps;
  std::string maps;
  for (const Parameterization* map : parameterizations())
    maps += fmt::format("{}{} ({})", maps.empty() ? "" : ", ", map->name(), map->sentence());
  verb.add_option("--maps", flags.maps, "comma-separated: " + maps)->capture_default_str();
  CLI::Option* side =
      verb.add_option("--map-size", flags.mapSize, "side of a map's layer, texels")->capture_default_str();
  verb.add_option("--map-texels", flags.mapTexels,
                  "texels of all layers together; picks the side, so that maps of different layer counts "
                  "compare fairly")
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
          .cull = parseCullMode(flags.cull)};
}

}  // namespace gnomon
