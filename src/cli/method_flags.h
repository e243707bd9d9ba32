#pragma once
// Flags of maps, biases and filters together: what compare and render draw.

#include "cli/bias_flags.h"
#include "cli/map_flags.h"

namespace gnomon {

struct MethodFlags {
  MapFlags map;
  BiasFlags bias;
  const CLI::App* verb = nullptr;  // which knows what was given
};
// `mapsTaken`, `biasesTaken`: how many the verb takes of the map's names, and of the biases' and filters': "one of".
void addMethodFlags(CLI::App& verb, MethodFlags& flags, const char* defaultBiases, const std::string& mapsTaken,
                    const std::string& biasesTaken);
// Throws UsageError; says on the terminal what is left out because it means nothing on a map. Where no map is named it
// stands for the one of chooseUsualMap, and is checked as if that were a cube.
CompareOptions compareOptions(const MethodFlags& flags);
// The map that suits the session's light, where none is named. Tells which flags that were given mean nothing to the
// maps, biases and filters that are then chosen.
void chooseUsualMap(const MethodFlags& flags, const Session& session, CompareOptions& options);

}  // namespace gnomon
