#pragma once
// The row of one method on one map, from its labels: what compare and sweep have in common.

#include "lab/compare/compare.h"

namespace gnomon {

// Of the unfiltered labels, with the filter's parameters; without what takes more to find: RMSE, FLIP, tuning,
// pictures, times and the command.
Row measuredRow(LightOnMap& lit, const Method& method, const LabelledResult& judged, const Filter& filter,
                const CompareOptions& options);

// Median width of the map's texels on the surfaces that are scored, metres; nothing of a volume, which holds no depths.
std::optional<double> medianTexelWidth(const LightOnMap& lit);

}  // namespace gnomon
