#pragma once
// What a row's params say of its map's own options, by the names of docs/results.md.

#include "shadow/parameterization.h"

#include <string>
#include <utility>
#include <vector>

namespace gnomon {

// Of a volume all of them; of a cube and a paraboloid those that are not at their defaults.
std::vector<std::pair<std::string, std::string>> mapParams(const FittedMap& fitted, const MapOptions& options);

}  // namespace gnomon
