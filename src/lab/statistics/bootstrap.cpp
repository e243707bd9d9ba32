#include "lab/statistics/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace gnomon {

namespace {

constexpr double kMedian = 0.5, kHigh = 0.95;

std::optional<Interval> intervalOf(std::vector<double>& drawn) {
  if (drawn.empty()) return std::nullopt;
  std::ranges::sort(drawn);
  return Interval{quantile(drawn, 0.025), quantile(drawn, 0.975)};
}

// Of sorted values, each counted as often as its group was drawn.
double weightedQuantile(const std::vector<GroupedValue>& sorted, const uint16_t* weights, uint64_t total,
                        double share) {
  const double wanted = share * static_cast<double>(total - 1);
  const auto below = static_cast<uint64_t>(wanted);
  const double between = wanted - static_cast<double>(below);
  uint64_t passed = 0;
  for (size_t i = 0; i < sorted.size(); ++i) {
    passed += weights[sorted[i].group];
    if (passed <= below) continue;
    if (passed > below + 1 || between == 0.0) return sorted[i].value;
    for (size_t next = i + 1; next < sorted.size(); ++next)
      if (weights[sorted[next].group] > 0) return std::lerp(sorted[i].value, sorted[next].value, between);
    return sorted[i].value;
  }
  return sorted.back().value;
}

size_t groupsIn(const std::vector<GroupedValue>& values, size_t groups) {
  std::vector<bool> seen(groups, false);
  for (const GroupedValue& value : values) seen[value.group] = true;
  return static_cast<size_t>(std::ranges::count(seen, true));
}

}  // namespace

Resamples::Resamples(size_t groups, size_t count, uint64_t seed)
    : groups_(groups), count_(count), weights_(groups * count, 0) {
  std::mt19937_64 random(seed);
  for (size_t r = 0; r < count; ++r)
    for (size_t i = 0; i < groups; ++i) ++weights_[r * groups + static_cast<size_t>(random() % groups)];
}

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(at);
  if (below + 1 >= sorted.size()) return sorted.back();
  return std::lerp(sorted[below], sorted[below + 1], at - static_cast<double>(below));
}

Estimate meanOf(const std::vector<GroupedValue>& values, const Resamples& resamples) {
  Estimate estimate;
  if (values.empty()) return estimate;
  std::vector<double> sums(resamples.groups(), 0.0);
  std::vector<size_t> counts(resamples.groups(), 0);
  double sum = 0.0;
  for (const auto& [value, group] : values) {
    sums[group] += value;
    ++counts[group];
    sum += value;
  }
  estimate.value = sum / static_cast<double>(values.size());
  if (groupsIn(values, resamples.groups()) < 2) return estimate;
  std::vector<double> drawn;
  for (size_t r = 0; r < resamples.count(); ++r) {
    const uint16_t* weights = resamples.weights(r);
    double total = 0.0, count = 0.0;
    for (size_t g = 0; g < resamples.groups(); ++g) {
      total += weights[g] * sums[g];
      count += static_cast<double>(weights[g] * counts[g]);
    }
    if (count > 0.0) drawn.push_back(total / count);
  }
  estimate.interval = intervalOf(drawn);
  return estimate;
}

Estimates estimatesOf(std::vector<GroupedValue> values, const Resamples& resamples) {
  Estimates estimates{.count = values.size()};
  if (values.empty()) return estimates;
  estimates.mean = meanOf(values, resamples);
  std::ranges::sort(values, {}, &GroupedValue::value);
  std::vector<double> sorted;
  for (const GroupedValue& value : values) sorted.push_back(value.value);
  estimates.median.value = quantile(sorted, kMedian);
  estimates.p95.value = quantile(sorted, kHigh);
  estimates.worst = sorted.back();
  if (groupsIn(values, resamples.groups()) < 2) return estimates;
  std::vector<double> medians, highs;
  for (size_t r = 0; r < resamples.count(); ++r) {
    const uint16_t* weights = resamples.weights(r);
    uint64_t total = 0;
    for (const GroupedValue& value : values) total += weights[value.group];
    if (total == 0) continue;
    medians.push_back(weightedQuantile(values, weights, total, kMedian));
    highs.push_back(weightedQuantile(values, weights, total, kHigh));
  }
  estimates.median.interval = intervalOf(medians);
  estimates.p95.interval = intervalOf(highs);
  return estimates;
}

}  // namespace gnomon
