#pragma once
// --fail-if: a threshold that turns a measurement into an exit code, for CI.
//
//   acne>0            any acne at all, in any row
//   adaptive:acne>0.1%    more than 0.1% of the scored pixels, in rows of that bias
//   spot/dual:leak>=10    in rows of that map and bias
//
// Metrics are the fields of a row that are declared as such (lab/results/row.h). Pixels are counts, unless a % follows;
// bias_error and all_wrong are shares, rmse and flip numbers, times milliseconds.

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

// "acne, leak, ..."
std::string thresholdMetrics();

// Throws UsageError.
Threshold parseThreshold(const std::string& text);

// Throws UsageError, with the nearest name, where no row of such a comparison will be one that it means.
void checkMeansARow(const Threshold& threshold, const CompareOptions& options);

// A line that says which row crossed it, or nothing. Throws UsageError where it means none of the rows.
std::optional<std::string> crossed(const Threshold& threshold, const std::vector<Row>& rows);

}  // namespace gnomon
