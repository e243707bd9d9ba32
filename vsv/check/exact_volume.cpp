#include "vsv/check/exact_volume.h"

#include "truth/continuity.h"

#include "base/check.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace gnomon {

namespace {

using Range = tbb::blocked_range<int>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How far the direction of a ray that floats describe may stray, radians: 8 roundings of 2^-24 along each of
// three axes are 2^-21 sqrt(3); twice that.
constexpr double kRayNoise = 0x1p-19;

struct Angles {
  double theta = 0.0, phi = 0.0;
};

Angles columnAngles(const glsl::EpipolarGrid& grid, int theta, int phi) {
  return {grid.thetaLower + (theta + 0.5) * grid.thetaStep, grid.phiLower + (phi + 0.5) * grid.phiStep};
}

// The occupancy rule in double: the first voxel whose centre lies behind.
int exactFirst(const glsl::EpipolarGrid& grid, double alphaOccluder) {
  const double steps = (alphaOccluder - grid.alphaLower) / grid.alphaStep - 0.5;
  return static_cast<int>(std::clamp(std::floor(steps) + 1.0, 0.0, static_cast<double>(grid.alphaCount)));
}

size_t bucketOf(int distance) {
  return std::bit_width(static_cast<unsigned>(distance));
}

// Whether anything ends within the noise of a ray's direction.
bool silhouetteAround(const Tracer& tracer, const RayD& ray, double margin) {
  const glm::dvec3 hint = std::abs(ray.dir.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(ray.dir, hint));
  const glm::dvec3 v = glm::cross(ray.dir, u);
  const Probe center = probeAlong(tracer, ray);
  for (const glm::dvec3& aside : {u, -u, v, -v}) {
    const RayD beside{ray.origin, glm::normalize(ray.dir + kRayNoise * aside)};
    if (!continuousBetween(tracer, center, probeAlong(tracer, beside), margin)) return true;
  }
  return false;
}

// One comparison's inputs.
struct Judge {
  const Tracer& tracer;
  const glsl::LightFrame& frame;
  const ExactVolume& exact;
  const ColumnBoundaries& measured;
  const ColumnSource& source;
  double margin;

  BoundaryCause cause(int theta, int phi) const {
    const glsl::EpipolarGrid& grid = measured.grid;
    const size_t c = columnIndex(grid, theta, phi);
    const int expected = exact.boundaries.first[c];
    if (source.rounding && std::abs(measured.first[c] - expected) == 1) {
      // The voxel on which the two disagree.
      const int voxel = std::min(measured.first[c], expected);
      const double center = grid.alphaLower + (voxel + 0.5) * grid.alphaStep;
      const double alpha = exact.alphaOccluder[c];
      if (std::abs(center - alpha) <= source.rounding(alpha, phi)) return BoundaryCause::Rounding;
    }
    const RayD own = columnRayW(frame, grid, theta, phi);
    if (source.covers && std::isfinite(exact.distance[c]) && !source.covers(own.origin + own.dir * exact.distance[c]))
      return BoundaryCause::Outside;
    if (source.rayW && !continuousBetween(tracer, own, source.rayW(theta, phi), margin))
      return BoundaryCause::Silhouette;
    if (!source.rayW && silhouetteAround(tracer, own, margin)) return BoundaryCause::Silhouette;
    return BoundaryCause::Resolution;
  }
};

BoundaryErrors emptyErrors(const glsl::EpipolarGrid& grid) {
  BoundaryErrors errors;
  errors.histogram.assign(bucketOf(grid.alphaCount) + 1, 0);
  errors.byCause.fill(errors.histogram);
  return errors;
}

void add(BoundaryHistogram& sum, const BoundaryHistogram& other) {
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += other[i];
}

BoundaryErrors sumOf(BoundaryErrors a, const BoundaryErrors& b) {
  a.columns += b.columns;
  a.tooDark += b.tooDark;
  a.tooLight += b.tooLight;
  add(a.histogram, b.histogram);
  for (size_t cause = 0; cause < a.byCause.size(); ++cause) add(a.byCause[cause], b.byCause[cause]);
  return a;
}

}  // namespace

const char* boundaryCauseName(BoundaryCause cause) {
  switch (cause) {
    case BoundaryCause::Rounding:
      return "rounding";
    case BoundaryCause::Outside:
      return "outside";
    case BoundaryCause::Silhouette:
      return "silhouette";
    case BoundaryCause::Resolution:
      return "resolution";
  }
  return "?";
}

int bucketStart(size_t bucket) {
  return bucket == 0 ? 0 : 1 << (bucket - 1);
}

RayD columnRayW(const glsl::LightFrame& frame, const glsl::EpipolarGrid& grid, int theta, int phi) {
  const Angles angles = columnAngles(grid, theta, phi);
  const double s = std::sin(angles.phi);
  const glm::dvec3 dirW = glm::dvec3(frame.rightW) * (s * std::sin(angles.theta)) +
                          glm::dvec3(frame.upW) * (s * std::cos(angles.theta)) +
                          glm::dvec3(frame.backW) * std::cos(angles.phi);
  return {.origin = glm::dvec3(frame.originW), .dir = glm::normalize(dirW)};
}

ExactVolume traceColumns(const Tracer& tracer, const glsl::LightFrame& frame, const glsl::EpipolarGrid& grid) {
  const size_t columns = columnCount(grid);
  ExactVolume exact{.boundaries = {grid, std::vector<int>(columns, grid.alphaCount)},
                    .alphaOccluder = std::vector<double>(columns, kInfinity),
                    .distance = std::vector<double>(columns, kInfinity)};
  tbb::parallel_for(Range(0, grid.phiCount), [&](const Range& phis) {
    for (int phi = phis.begin(); phi != phis.end(); ++phi) {
      for (int theta = 0; theta < grid.thetaCount; ++theta) {
        const std::optional<SurfaceHit> hit = tracer.firstHit(columnRayW(frame, grid, theta, phi));
        if (!hit) continue;
        const size_t c = columnIndex(grid, theta, phi);
        const double angle = columnAngles(grid, theta, phi).phi;
        const double r = hit->distance;
        exact.distance[c] = r;
        exact.alphaOccluder[c] = std::atan2(r * std::sin(angle), grid.eyeDistance - r * std::cos(angle));
        exact.boundaries.first[c] = exactFirst(grid, exact.alphaOccluder[c]);
      }
    }
  });
  return exact;
}

BoundaryErrors compareBoundaries(const Tracer& tracer, const glsl::LightFrame& frame, const ExactVolume& exact,
                                 const ColumnBoundaries& measured, const ColumnSource& source, double margin) {
  const glsl::EpipolarGrid& grid = measured.grid;
  GNOMON_CHECK_EQ(measured.first.size(), exact.boundaries.first.size());
  const Judge judge{tracer, frame, exact, measured, source, margin};
  BoundaryErrors errors = tbb::parallel_reduce(
      Range(0, grid.phiCount), emptyErrors(grid),
      [&](const Range& phis, BoundaryErrors sum) {
        for (int phi = phis.begin(); phi != phis.end(); ++phi) {
          for (int theta = 0; theta < grid.thetaCount; ++theta) {
            const size_t c = columnIndex(grid, theta, phi);
            const int off = measured.first[c] - exact.boundaries.first[c];
            const size_t bucket = bucketOf(std::abs(off));
            ++sum.histogram[bucket];
            if (off == 0) continue;
            (off < 0 ? sum.tooDark : sum.tooLight) += static_cast<uint64_t>(std::abs(off));
            ++sum.byCause[static_cast<size_t>(judge.cause(theta, phi))][bucket];
          }
        }
        return sum;
      },
      [](const BoundaryErrors& a, const BoundaryErrors& b) { return sumOf(a, b); });
  errors.columns = columnCount(grid);
  return errors;
}

}  // namespace gnomon
