#include "planar/cascades.h"

#include <cmath>

namespace gnomon {

std::vector<double> cascadeSplits(double nearest, double farthest, int count) {
  std::vector<double> splits;
  for (int i = 0; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    const double logarithmic = nearest * std::pow(farthest / nearest, share);
    const double uniform = nearest + (farthest - nearest) * share;
    splits.push_back(kCascadeLambda * logarithmic + (1.0 - kCascadeLambda) * uniform);
  }
  splits.front() = nearest;
  splits.back() = farthest;
  return splits;
}

}  // namespace gnomon
