#pragma once
// The list of all parameterizations, by their names on the command line.

#include "shadow/parameterization.h"

namespace gnomon {

// Planar maps first, then those of omni/, then the shadow volume.
const std::vector<const Parameterization*>& parameterizations();

// "a,b" to parameterizations. Throws UsageError that lists the names.
std::vector<const Parameterization*> parseMaps(const std::string& list);

// What they declare, each once, in their order.
const std::vector<const MapOption*>& allMapOptions();

}  // namespace gnomon
