#pragma once
// The map options in a row's `params`, by the names in docs/results.md.

#include "lab/results/row.h"
#include "shadow/parameterization.h"

namespace gnomon {

// Options of every row first, then the map's own, then what it says of the fit.
Params mapParams(const Parameterization& map, const FittedMap& fitted, const MapOptions& options);

}  // namespace gnomon
