#pragma once
// Flags of maps, biases and filters together: what compare and render draw.

#include "cli/bias_flags.h"
#include "cli/map_flags.h"

namespace gnomon {

struct MethodFlags {
  MapFlags map;
  BiasFlags bias;
};
void addMethodFlags(CLI::App& verb, MethodFlags& flags, const char* defaultMaps, const char* defaultBiases);
// Throws UsageError; says on the terminal what is left out because it means nothing on a map.
CompareOptions compareOptions(const MethodFlags& flags);

}  // namespace gnomon
