#pragma once
// Errors and costs of an integrator, and how it compares with ray marching.

#include "lab/core/method.h"
#include "lab/fog/fog_methods.h"
#include "lab/results/media_row.h"

#include <optional>
#include <string>

namespace gnomon {

// The root of the mean square difference, over the reference's mean. Of a black reference, which has none, the root
// itself.
// `share`: of the pixels, those that err least.
double relativeRmse(const ImageF& measured, const ImageF& reference, double share = 1.0);

// What a pixel changes from a frame to the next beyond what the reference changes: the mean of
// |(measured' - measured) - (reference' - reference)|. Signed changes are compared, so that a pixel that
// darkens by what it should brighten counts twice, and one that lags behind counts as well.
double changeBeyond(const ImageF& measured, const ImageF& measuredNext, const ImageF& reference,
                    const ImageF& referenceNext);

double meanValue(const ImageF& image);

// Of each row with an error that is no baseline, with and without builds, by both measures: read off the baseline's
// curve of error over time (steps are joined by straight lines in log-log). Empty without a baseline.
std::vector<EqualTerms> equalTerms(const std::vector<MediaRow>& rows);

// "12.3", ">= 12.3", "<= 0.8".
std::string factorText(const Factor& factor);

// The square of kWorstSide pixels with the largest errors for their brightness: where shafts' edges are, not
// where the light itself is.
std::optional<WorstPlace> worstMediaPlace(const ImageF& measured, const ImageF& reference);

}  // namespace gnomon
