#pragma once
// How good a way to integrate is, what it costs, and how it stands against a march.

#include "lab/core/method.h"
#include "lab/results/schema.h"
#include "lab/fog/fog_methods.h"

#include <optional>
#include <string>

namespace gnomon {

struct MediaRow {
  MediaMethod method;
  std::string map;                                       // "vsv", or the march's: "cube", "paraboloid"
  std::string mapSize;                                   // mapSizeText
  double mapMs = 0.0, tableMs = 0.0, integrateMs = 0.0;  // medians, wall clock, all lights together
  double buildMs() const { return mapMs + tableMs; }
  double totalMs() const { return buildMs() + integrateMs; }
  // Of the in-scattered light against the reference, over pixels and channels, as a share of the reference's
  // mean. Absent where there is no reference.
  std::optional<double> relRmse;
  // The same over the 99 % of the pixels that err least: beside a visible light, where the integrand grows as
  // 1/r^2, few pixels decide the other.
  std::optional<double> relRmse99;
  // Mean FLIP of the exposed picture against the reference's, surfaces and all.
  std::optional<double> flip;
  std::optional<double> flicker;  // of --frames
  Pictures pictures;
};

// The root of the mean square difference, over the reference's mean. 0 where both are black; infinity where
// only the reference is.
// `share`: of the pixels, those that err least.
double relativeRmse(const ImageF& measured, const ImageF& reference, double share = 1.0);

// What a pixel changes from a frame to the next beyond what the reference changes: the mean of
// |(measured' - measured) - (reference' - reference)|. Signed changes are compared, so that a pixel that
// darkens by what it should brighten counts twice, and one that lags behind counts as well.
double changeBeyond(const ImageF& measured, const ImageF& measuredNext, const ImageF& reference,
                    const ImageF& referenceNext);

double meanValue(const ImageF& image);

// A row against the march of the same run, on the march's curve of error over time (steps are joined by
// straight lines in log-log).
enum class Bound {
  Exact,
  AtLeast,  // the march does not reach this error with the most steps tried; nor is it that fast with the
            // fewest
  AtMost,   // the march is better or faster already with the fewest steps tried
};
struct Factor {
  double value = 0.0;
  Bound bound = Bound::Exact;
};
enum class ErrorMeasure { RelRmse, RelRmse99 };
const char* errorMeasureName(ErrorMeasure measure);  // rel_rmse, rel_rmse_99
struct EqualTerms {
  size_t row = 0;          // of the rows
  bool withBuild = false;  // volumes, maps and tables count
  ErrorMeasure measure = ErrorMeasure::RelRmse;
  Factor faster;  // at equal error: the march's time over the row's
  Factor better;  // at equal time: the march's error over the row's
};

// Of each row with an error that is no march, with and without builds, by both measures; empty without a
// march.
std::vector<EqualTerms> equalTerms(const std::vector<MediaRow>& rows);

// "12.3", ">= 12.3", "<= 0.8".
std::string factorText(const Factor& factor);

// The square of kWorstSide pixels with the largest errors for their brightness: where shafts' edges are, not
// where the light itself is.
std::optional<WorstPlace> worstMediaPlace(const ImageF& measured, const ImageF& reference);

}  // namespace gnomon
