#pragma once
// The smallest map of each method at which few enough pixels are wrong, edges included: what people decide by.
//
//   side   16 --- 32 --- 64 --- 128 --- 256         doubled until it is good enough,
//                               |  *  |             then halved in its logarithm, to a quarter of a doubling

#include "lab/compare/compare.h"

#include <string>

namespace gnomon {

// Of the unfiltered maps, each bias at the options' parameters. A larger map is taken to be no worse; where one is, a
// smaller one that would do may be missed. Shadow volumes have no side and are left out.
EqualError findEqualError(const Session& session, ShadowPasses& passes, const CompareOptions& options,
                          double gbufferMs);

// For a terminal. Empty where nothing was searched.
std::string equalErrorTable(const Comparison& comparison);

}  // namespace gnomon
