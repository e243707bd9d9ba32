#pragma once
// The list of all parameterizations, by their names on the command line.

#include "shadow/parameterization.h"

namespace gnomon {

// Planar maps first, then those of omni/, then the shadow volume.
const std::vector<const Parameterization*>& parameterizations();

// "a,b" to parameterizations. Throws UsageError that lists the names.
std::vector<const Parameterization*> parseMaps(const std::string& list);

// The map that a light of this kind gets where nobody names one: of all directions for a point light, of one plane for
// a spot or a directional light; another that can be made of it where an option is chosen that this one does not have.
const Parameterization& usualMapFor(LightType type, const MapOptions& options);

// What they declare, each once, in their order.
const std::vector<const MapOption*>& allMapOptions();

}  // namespace gnomon
