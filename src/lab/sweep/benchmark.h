#pragma once
// `gnomon sweep benchmark`: the plan behind docs/findings.md. It is frozen: what changes a number in it raises its
// version.

#include "lab/sweep/plan.h"

namespace gnomon {

inline constexpr int kBenchmarkVersion = 1;

// The whole, or a small share of it for a few minutes.
Plan benchmarkPlan(bool quick);

}  // namespace gnomon
