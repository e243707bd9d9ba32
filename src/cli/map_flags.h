#pragma once
// Flags that choose maps and how they are drawn. Those of one kind of map come from its own list of options
// (Parameterization::options).

#include "lab/core/method.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gnomon {

struct MapFlags {
  std::string maps;    // empty: by the light
  int mapSize = 1024;  // texels of a slice's side
  long mapTexels = 0;
  std::string cull = "solids";
  std::optional<float> exposure;  // of pictures, where the verb has the flag
  MapOptions options;
};
// --maps, --map-size, --map-texels, --cull, and a flag for each option of each map.
// `howMany`: how many of them the verb takes, "one of".
void addMapFlags(CLI::App& verb, MapFlags& flags, const std::string& howMany);
void addCullFlag(CLI::App& verb, MapFlags& flags);
void addMapOptionFlags(CLI::App& verb, MapFlags& flags, const std::vector<const MapOption*>& options);

// What they choose. Throws UsageError where an option or a size cannot be had.
MapChoice mapChoice(const MapFlags& flags);

}  // namespace gnomon
