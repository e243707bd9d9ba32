#pragma once
// FLIP: how different two pictures look to a viewer who flips between them, from 0 (equal) to 1.
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020 (LDR-FLIP). Pooling as in section 5 there: percentiles are weighted by the error, so that a large
// area without error does not hide a small one with much.

#include "base/image.h"

namespace gnomon {

struct Flip {
  double mean = 0.0;
  double weightedMedian = 0.0;  // half of all error lies in pixels of at most this much
  double firstWeightedQuartile = 0.0;
  double thirdWeightedQuartile = 0.0;
  double max = 0.0;
  ImageF map;  // one channel, an error a pixel
};

// The paper's viewing conditions: a screen of 3840 pixels and 0.7 m width seen from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67.02064327658226;  // 0.7 * 3840 / 0.7 * pi / 180

// sRGB pictures of equal size with 1 (grey), 3 or 4 (the fourth is ignored) channels. Throws WorldError.
Flip computeFlip(const Image8& reference, const Image8& test, double pixelsPerDegree = kFlipPixelsPerDegree);

// The map in the colours of "magma": black 0, white 1.
Image8 flipPicture(const ImageF& map);

}  // namespace gnomon
