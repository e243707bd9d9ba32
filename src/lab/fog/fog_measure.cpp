#include "lab/fog/fog_measure.h"

#include "base/check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace gnomon {

namespace {

struct CurvePoint {
  double ms = 0.0, error = 0.0;
};

std::optional<double> errorOf(const MediaRow& row, ErrorMeasure measure) {
  return measure == ErrorMeasure::RelRmse ? row.relRmse : row.relRmse99;
}

double costOf(const MediaRow& row, bool withBuild) {
  return withBuild ? row.totalMs() : row.integrateMs;
}

// By time.
std::vector<CurvePoint> baselineCurve(const std::vector<MediaRow>& rows, bool withBuild, ErrorMeasure measure) {
  std::vector<CurvePoint> curve;
  for (const MediaRow& row : rows)
    if (row.isBaseline && errorOf(row, measure)) curve.push_back({costOf(row, withBuild), *errorOf(row, measure)});
  std::ranges::sort(curve, {}, &CurvePoint::ms);
  return curve;
}

bool isUsable(const CurvePoint& point) {
  return point.ms > 0.0 && point.error > 0.0 && std::isfinite(point.error);
}

double logarithmic(double x, double x0, double x1, double y0, double y1) {
  const double share = std::log(x / x0) / std::log(x1 / x0);
  return std::exp(std::log(y0) + share * (std::log(y1) - std::log(y0)));
}

// The baseline's time for an error, over `ms`.
Factor fasterAt(const std::vector<CurvePoint>& curve, double error, double ms) {
  if (curve.front().error <= error) return {curve.front().ms / ms, Bound::AtMost};
  for (size_t i = 1; i < curve.size(); ++i)
    if (curve[i].error <= error)
      return {logarithmic(error, curve[i - 1].error, curve[i].error, curve[i - 1].ms, curve[i].ms) / ms, Bound::Exact};
  return {curve.back().ms / ms, Bound::AtLeast};
}

// The baseline's error in a time, over `error`.
Factor betterAt(const std::vector<CurvePoint>& curve, double ms, double error) {
  if (ms < curve.front().ms) return {curve.front().error / error, Bound::AtLeast};
  for (size_t i = 1; i < curve.size(); ++i)
    if (ms <= curve[i].ms)
      return {logarithmic(ms, curve[i - 1].ms, curve[i].ms, curve[i - 1].error, curve[i].error) / error, Bound::Exact};
  return {curve.back().error / error, Bound::AtMost};
}

}  // namespace

double meanValue(const ImageF& image) {
  double sum = 0.0;
  for (const float value : image.values) sum += static_cast<double>(value);
  return image.values.empty() ? 0.0 : sum / static_cast<double>(image.values.size());
}

double relativeRmse(const ImageF& measured, const ImageF& reference, double share) {
  GNOMON_CHECK_EQ(measured.values.size(), reference.values.size());
  std::vector<double> squares(reference.values.size() / 3, 0.0);  // one a pixel
  for (size_t i = 0; i < reference.values.size(); ++i) {
    const double difference = static_cast<double>(measured.values[i]) - static_cast<double>(reference.values[i]);
    squares[i / 3] += difference * difference;
  }
  const auto kept = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(squares.size())));
  if (kept < std::ssize(squares)) std::ranges::nth_element(squares, squares.begin() + kept);
  const double sum = std::accumulate(squares.begin(), squares.begin() + kept, 0.0);
  const double mean = meanValue(reference);
  return std::sqrt(sum / (3.0 * static_cast<double>(kept))) / (mean > 0.0 ? mean : 1.0);
}

double changeBeyond(const ImageF& measured, const ImageF& measuredNext, const ImageF& reference,
                    const ImageF& referenceNext) {
  double sum = 0.0;
  for (size_t i = 0; i < reference.values.size(); ++i) {
    const double change = static_cast<double>(measuredNext.values[i]) - static_cast<double>(measured.values[i]);
    const double due = static_cast<double>(referenceNext.values[i]) - static_cast<double>(reference.values[i]);
    sum += std::abs(change - due);
  }
  return sum / static_cast<double>(reference.values.size());
}

std::vector<EqualTerms> equalTerms(const std::vector<MediaRow>& rows) {
  std::vector<EqualTerms> terms;
  const auto baseline = std::ranges::find(rows, true, &MediaRow::isBaseline);
  if (baseline == rows.end()) return terms;
  for (const MediaRow& row : rows) {
    if (row.isBaseline) continue;
    for (const bool withBuild : {true, false}) {
      for (const ErrorMeasure measure : {ErrorMeasure::RelRmse, ErrorMeasure::RelRmse99}) {
        const std::vector<CurvePoint> curve = baselineCurve(rows, withBuild, measure);
        const CurvePoint own{costOf(row, withBuild), errorOf(row, measure).value_or(0.0)};
        if (curve.empty() || !std::ranges::all_of(curve, isUsable) || !isUsable(own)) continue;
        terms.push_back({.integrator = row.integrator,
                         .steps = row.steps,
                         .against = baseline->integrator,
                         .withBuild = withBuild,
                         .measure = measure,
                         .faster = fasterAt(curve, own.error, own.ms),
                         .better = betterAt(curve, own.ms, own.error)});
      }
    }
  }
  return terms;
}

std::string factorText(const Factor& factor) {
  const char* sign = factor.bound == Bound::AtLeast ? ">= " : factor.bound == Bound::AtMost ? "<= " : "";
  return fmt::format("{}{:.3g}", sign, factor.value);
}

std::optional<WorstPlace> worstMediaPlace(const ImageF& measured, const ImageF& reference) {
  const int width = reference.width, height = reference.height;
  const double mean = meanValue(reference);
  // Summed areas (Crow 1984), one row and column more than the picture.
  const auto stride = static_cast<size_t>(width) + 1;
  std::vector<double> sums(stride * (static_cast<size_t>(height) + 1), 0.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double squares = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double exact = static_cast<double>(reference.at(x, y)[c]);
        const double share = (static_cast<double>(measured.at(x, y)[c]) - exact) / (exact + mean);
        if (std::isfinite(share)) squares += share * share;
      }
      const size_t at = (static_cast<size_t>(y) + 1) * stride + static_cast<size_t>(x) + 1;
      sums[at] = sums[at - stride] + sums[at - 1] - sums[at - stride - 1] + squares;
    }
  }
  const int size = std::min({kWorstSide, width, height});
  WorstPlace worst{.size = size};
  double most = 0.0;
  for (int y = 0; y + size <= height; ++y) {
    for (int x = 0; x + size <= width; ++x) {
      const auto at = [&](int column, int row) {
        return sums[static_cast<size_t>(row) * stride + static_cast<size_t>(column)];
      };
      const double squares = at(x + size, y + size) - at(x, y + size) - at(x + size, y) + at(x, y);
      if (!(squares > most)) continue;
      most = squares;
      worst.x = x;
      worst.y = y;
    }
  }
  return most > 0.0 ? std::optional(worst) : std::nullopt;
}

}  // namespace gnomon
