#pragma once
// What a row's params say of its map's options, by the names of docs/results.md.

#include "lab/results/row.h"
#include "shadow/parameterization.h"

namespace gnomon {

// Options of every row first, then the map's own, then what it says of the fit.
Params mapParams(const Parameterization& map, const FittedMap& fitted, const MapOptions& options);

}  // namespace gnomon
