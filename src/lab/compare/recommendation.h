#pragma once
// What a comparison advises, in words: map, size, bias, value, cost, and how good that stays elsewhere.

#include "lab/results/comparison.h"

#include <string>

namespace gnomon {

std::string percentText(double share);  // "0.123%"

// The parameters of a row: "offset 0.01 m, factor 2".
std::string knobText(const Row& row);

// Two lines about the best row whose parameters nobody searched, one that names what is as good within what the exact
// shadow can tell, and where some were searched two about the best of those. Empty where fewer than two methods were
// compared; says why where the light lights nothing.
std::string recommendation(const Comparison& comparison);

}  // namespace gnomon
