#pragma once
// --fail-if: a threshold that turns a measurement into an exit code, for CI.
//
//   acne>0            any acne at all, in any row
//   adaptive:acne>0.1%    more than 0.1% of the scored pixels, in rows of that bias
//   spot/dual:leak>=10    in rows of that map and bias
//
// Metrics: acne, leak, edge_shadow, edge_light, edge, uncovered, bias_error, rmse. Counts, unless a %
// follows; bias_error is a share, rmse a number.

#include "lab/compare/compare.h"

#include <optional>
#include <string>

namespace gnomon {

struct Threshold {
  std::string text;
  std::string map;   // empty: any
  std::string bias;  // empty: any
  std::string metric;
  bool orEqual = false;
  bool below = false;  // < instead of >
  bool percent = false;
  double limit = 0.0;
};

// Throws UsageError.
Threshold parseThreshold(const std::string& text);

// A line that says which row crossed it, or nothing.
std::optional<std::string> crossed(const Threshold& threshold, const std::vector<Row>& rows);

}  // namespace gnomon
