#pragma once
// The distances at which a view is split into cascades.

#include <vector>

namespace gnomon {

// The share of the logarithmic scheme in the practical one.
inline constexpr double kCascadeLambda = 0.5;

// count + 1 view depths from nearest to farthest, 0 < nearest <= farthest. The practical split scheme of
// Zhang, Sun, Xu, Lun, "Parallel-Split Shadow Maps for Large-scale Virtual Environments", VRCIA 2006,
// section 3.1: C_i = lambda n (f/n)^(i/m) + (1 - lambda) (n + (f - n) i/m).
std::vector<double> cascadeSplits(double nearest, double farthest, int count);

}  // namespace gnomon
