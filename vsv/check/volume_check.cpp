#include "vsv/check/volume_check.h"

#include "base/check.h"

#include <bit>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace gnomon {

namespace {

using Range = tbb::blocked_range<int>;

BitsCheck operator+(const BitsCheck& a, const BitsCheck& b) {
  return {a.voxels + b.voxels, a.mismatches + b.mismatches, a.withinTolerance + b.withinTolerance};
}

// One theta's columns, by phi.
struct Columns {
  std::vector<int> first;
  std::vector<float> alphaOccluders, tolerances;
};

Columns columnsOf(const ColumnBoundaries& implied, std::span<const float> alphaOccluders,
                  std::span<const float> tolerances, int theta) {
  Columns columns;
  for (int phi = 0; phi < implied.grid.phiCount; ++phi) {
    const size_t c = columnIndex(implied.grid, theta, phi);
    columns.first.push_back(implied.first[c]);
    columns.alphaOccluders.push_back(alphaOccluders[c]);
    columns.tolerances.push_back(tolerances.empty() ? 0.0f : tolerances[c]);
  }
  return columns;
}

// Bits of one theta that differ, told apart by how near their voxel's centre is to the occluder.
BitsCheck checkTheta(const DenseVolume& measured, const Columns& columns, int theta) {
  const glsl::EpipolarGrid& grid = measured.grid;
  BitsCheck check;
  for (int alpha = 0; alpha < grid.alphaCount; ++alpha) {
    const float center = glsl::alphaCenter(grid, alpha);
    for (int w = 0; w < measured.phiWordCount(); ++w) {
      uint64_t expected = 0;
      for (int b = 0; b < kWordBits; ++b)
        expected |= static_cast<uint64_t>(columns.first[w * kWordBits + b] <= alpha) << b;
      const uint64_t different = expected ^ measured.words[measured.wordIndex(alpha, theta, w)];
      for (uint64_t left = different; left != 0; left &= left - 1) {
        const int phi = w * kWordBits + std::countr_zero(left);
        const bool near =
            columns.tolerances[phi] > 0.0f && std::abs(center - columns.alphaOccluders[phi]) <= columns.tolerances[phi];
        ++(near ? check.withinTolerance : check.mismatches);
      }
    }
  }
  check.voxels = static_cast<uint64_t>(grid.alphaCount) * grid.phiCount;
  return check;
}

}  // namespace

// alpha = atan2(a, D - z) of a point P = r dir, a its distance from the axis, found by a map's texel. In
// units of 2^-23, between two processors:
// - sin and cos differ by 1 ulp, their products by 1/2 more: 2.5 for each coordinate of dir;
// - r is the texel's depth by dir's share along the face's axis, at least 1/sqrt(3), after two rotations of
//   2 ulps each: 6.5 sqrt(3) = 11.3 r;
// - their product rounds by 1/2 along each axis, r itself by 1/2: P lies off by at most
//   (11.3 + 2.5 + 1.4) r in all, and D - z rounds by 1/2 D once more;
// - seen from E at the distance d that is an angle of (15.2 r + 0.5 D) / d, and the law of sines has
//   r / d = sin alpha / sin phi, D / d = sin(phi + alpha) / sin phi.
// The arc tangent itself adds 4e-6, whatever its value: 3.3e-6 was measured, and a test holds it to 4e-6.
float alphaTolerance(float alphaOccluder, float phi) {
  constexpr float kUlp = 0x1p-23f;
  constexpr float kArcTangent = 4e-6f;
  if (!(alphaOccluder < glsl::kPi)) return 0.0f;
  const float perDistance =
      (15.2f * std::sin(alphaOccluder) + 0.5f * std::abs(std::sin(phi + alphaOccluder))) / std::sin(phi);
  return kArcTangent + kUlp * perDistance;
}

BitsCheck checkBits(const DenseVolume& measured, std::span<const float> alphaOccluders,
                    std::span<const float> tolerances) {
  const glsl::EpipolarGrid& grid = measured.grid;
  GNOMON_CHECK(tolerances.empty() || tolerances.size() == alphaOccluders.size());
  const ColumnBoundaries implied = impliedBoundaries(grid, alphaOccluders);
  return tbb::parallel_reduce(
      Range(0, grid.thetaCount), BitsCheck{},
      [&](const Range& thetas, BitsCheck sum) {
        for (int theta = thetas.begin(); theta != thetas.end(); ++theta)
          sum = sum + checkTheta(measured, columnsOf(implied, alphaOccluders, tolerances, theta), theta);
        return sum;
      },
      [](const BitsCheck& a, const BitsCheck& b) { return a + b; });
}

OccluderCheck checkOccluders(std::span<const float> measured, std::span<const float> expected,
                             std::span<const float> tolerances) {
  GNOMON_CHECK_EQ(measured.size(), expected.size());
  GNOMON_CHECK_EQ(measured.size(), tolerances.size());
  OccluderCheck check{.columns = measured.size()};
  for (size_t c = 0; c < measured.size(); ++c) {
    if (std::bit_cast<uint32_t>(measured[c]) == std::bit_cast<uint32_t>(expected[c])) {
      ++check.equal;
      continue;
    }
    const float difference = std::abs(measured[c] - expected[c]);
    ++(difference <= tolerances[c] ? check.withinTolerance : check.beyond);
    if (std::isfinite(difference)) check.largest = std::max(check.largest, difference);
  }
  return check;
}

}  // namespace gnomon
