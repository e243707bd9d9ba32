#pragma once
// What a row's params say of its map's options, by the names of docs/results.md.

#include "shadow/parameterization.h"

#include <vector>

namespace gnomon {

// Options of every row first, then the map's own, then what it says of the fit.
std::vector<MapParam> mapParams(const Parameterization& map, const FittedMap& fitted, const MapOptions& options);

}  // namespace gnomon
