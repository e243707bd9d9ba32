#include "lab/fog_measure.h"

#include "base/check.h"
#include "lab/row_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace gnomon {

namespace {

struct CurvePoint {
  double ms = 0.0, error = 0.0;
};

// From the fewest steps to the most, by time.
std::vector<CurvePoint> marchCurve(const std::vector<MediaRow>& rows, bool withBuild) {
  std::vector<CurvePoint> curve;
  for (const MediaRow& row : rows)
    if (row.method.integrator == Integrator::March && row.relRmse)
      curve.push_back({withBuild ? row.totalMs() : row.integrateMs, *row.relRmse});
  std::ranges::sort(curve, {}, &CurvePoint::ms);
  return curve;
}

double logarithmic(double x, double x0, double x1, double y0, double y1) {
  const double share = std::log(x / x0) / std::log(x1 / x0);
  return std::exp(std::log(y0) + share * (std::log(y1) - std::log(y0)));
}

// The march's time for an error, over `ms`.
Factor fasterAt(const std::vector<CurvePoint>& curve, double error, double ms) {
  if (curve.front().error <= error) return {curve.front().ms / ms, Bound::AtMost};
  for (size_t i = 1; i < curve.size(); ++i)
    if (curve[i].error <= error)
      return {logarithmic(error, curve[i - 1].error, curve[i].error, curve[i - 1].ms, curve[i].ms) / ms,
              Bound::Exact};
  return {curve.back().ms / ms, Bound::AtLeast};
}

// The march's error in a time, over `error`.
Factor betterAt(const std::vector<CurvePoint>& curve, double ms, double error) {
  if (ms < curve.front().ms) return {curve.front().error / error, Bound::AtLeast};
  for (size_t i = 1; i < curve.size(); ++i)
    if (ms <= curve[i].ms)
      return {logarithmic(ms, curve[i - 1].ms, curve[i].ms, curve[i - 1].error, curve[i].error) / error,
              Bound::Exact};
  return {curve.back().error / error, Bound::AtMost};
}

}  // namespace

double meanValue(const ImageF& image) {
  double sum = 0.0;
  for (const float value : image.values) sum += static_cast<double>(value);
  return image.values.empty() ? 0.0 : sum / static_cast<double>(image.values.size());
}

double relativeRmse(const ImageF& measured, const ImageF& reference) {
  GNOMON_CHECK_EQ(measured.values.size(), reference.values.size());
  double squares = 0.0;
  for (size_t i = 0; i < reference.values.size(); ++i) {
    const double difference =
        static_cast<double>(measured.values[i]) - static_cast<double>(reference.values[i]);
    squares += difference * difference;
  }
  const double rmse = std::sqrt(squares / static_cast<double>(reference.values.size()));
  if (rmse == 0.0) return 0.0;
  const double mean = meanValue(reference);
  return mean > 0.0 ? rmse / mean : std::numeric_limits<double>::infinity();
}

double changeBeyond(const ImageF& measured, const ImageF& measuredNext, const ImageF& reference,
                    const ImageF& referenceNext) {
  double sum = 0.0;
  for (size_t i = 0; i < reference.values.size(); ++i) {
    const double change =
        static_cast<double>(measuredNext.values[i]) - static_cast<double>(measured.values[i]);
    const double due =
        static_cast<double>(referenceNext.values[i]) - static_cast<double>(reference.values[i]);
    sum += std::abs(change - due);
  }
  return sum / static_cast<double>(reference.values.size());
}

std::vector<EqualTerms> equalTerms(const std::vector<MediaRow>& rows) {
  std::vector<EqualTerms> terms;
  for (const bool withBuild : {true, false}) {
    const std::vector<CurvePoint> curve = marchCurve(rows, withBuild);
    const bool usable = !curve.empty() && std::ranges::all_of(curve, [](const CurvePoint& point) {
      return point.ms > 0.0 && point.error > 0.0 && std::isfinite(point.error);
    });
    if (!usable) continue;
    for (size_t i = 0; i < rows.size(); ++i) {
      const MediaRow& row = rows[i];
      if (row.method.integrator == Integrator::March || !row.relRmse) continue;
      const double ms = withBuild ? row.totalMs() : row.integrateMs;
      if (!(*row.relRmse > 0.0) || !std::isfinite(*row.relRmse) || !(ms > 0.0)) continue;
      terms.push_back({.row = i,
                       .withBuild = withBuild,
                       .faster = fasterAt(curve, *row.relRmse, ms),
                       .better = betterAt(curve, ms, *row.relRmse)});
    }
  }
  return terms;
}

std::string factorText(const Factor& factor) {
  const char* sign = factor.bound == Bound::AtLeast ? ">= " : factor.bound == Bound::AtMost ? "<= " : "";
  return fmt::format("{}{:.3g}", sign, factor.value);
}

std::optional<WorstPlace> worstMediaPlace(std::span<const ImageF> measured, const ImageF& reference) {
  const int width = reference.width, height = reference.height;
  // Summed areas (Crow 1984), one row and column more than the picture.
  const auto stride = static_cast<size_t>(width) + 1;
  std::vector<double> sums(stride * (static_cast<size_t>(height) + 1), 0.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double squares = 0.0;
      for (const ImageF& image : measured)
        for (int c = 0; c < 3; ++c) {
          const double difference =
              static_cast<double>(image.at(x, y)[c]) - static_cast<double>(reference.at(x, y)[c]);
          squares += difference * difference;
        }
      const size_t at = (static_cast<size_t>(y) + 1) * stride + static_cast<size_t>(x) + 1;
      sums[at] = sums[at - stride] + sums[at - 1] - sums[at - stride - 1] + squares;
    }
  }
  const int size = std::min({kWorstSide, width, height});
  WorstPlace worst{.size = size, .pixels = static_cast<size_t>(size) * static_cast<size_t>(size)};
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
