#pragma once
// The cluster bootstrap: intervals for statistics of cases that come in groups (Efron & Tibshirani, "An Introduction to
// the Bootstrap", 1993, chapters 8 and 13: percentile intervals). Cases of one scene are alike, so that drawing single
// cases would give intervals that are too narrow; whole groups are drawn instead.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace gnomon {

struct Interval {
  double lower = 0.0, upper = 0.0;  // that hold the middle 95 % of the resamples
};

// How often each of `groups` groups is drawn, in each of so many resamples: the same for all methods, so that they are
// compared on the same draws.
class Resamples {
 public:
  Resamples(size_t groups, size_t count, uint64_t seed);
  size_t groups() const { return groups_; }
  size_t count() const { return count_; }
  const uint16_t* weights(size_t resample) const { return weights_.data() + resample * groups_; }

 private:
  size_t groups_, count_;
  std::vector<uint16_t> weights_;
};

struct GroupedValue {
  double value = 0.0;
  size_t group = 0;
};

// `share` in 0..1 of the sorted values, between neighbours linearly; of values with weights the first at which so many
// lie below.
double quantile(const std::vector<double>& sorted, double share);

// Statistics of values, whole, and their intervals: none with fewer than two groups. Where a resample draws no value it
// is passed over.
struct Estimate {
  double value = 0.0;
  std::optional<Interval> interval;
};
struct Estimates {
  size_t count = 0;
  Estimate mean, median, p95;
  double worst = 0.0;
};
Estimates estimatesOf(std::vector<GroupedValue> values, const Resamples& resamples);
Estimate meanOf(const std::vector<GroupedValue>& values, const Resamples& resamples);

}  // namespace gnomon
