#include "truth/visibility.h"

#include "base/check.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

// Pixels traced together, square so that their rays stay alike.
constexpr int kTileSide = 4;
static_assert(kTileSide * kTileSide == static_cast<int>(Tracer::kPacket));

// Gathers one tile's scored pixels, and writes how high each one's blocker is.
void traceTile(const Tracer& tracer, const LightRays& rays, const Receivers& receivers, int tileX, int tileY,
               double enough, std::vector<double>& heights) {
  std::array<ShadowSegment, Tracer::kPacket> segments;
  std::array<size_t, Tracer::kPacket> pixels;
  std::array<double, Tracer::kPacket> found;
  size_t count = 0;
  for (int y = tileY; y < std::min(tileY + kTileSide, receivers.height); ++y) {
    for (int x = tileX; x < std::min(tileX + kTileSide, receivers.width); ++x) {
      const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(receivers.width) + static_cast<size_t>(x);
      if (receivers.states[pixel] != PixelState::Scored) continue;
      const SurfaceSample& sample = receivers.samples[pixel];
      const LightRay towards = rays.towards(sample.positionW);
      segments[count] = {towards.ray, towards.distance, sample.primitive, sample.normalW};
      pixels[count++] = pixel;
    }
  }
  tracer.blockerHeights({segments.data(), count}, enough, {found.data(), count});
  for (size_t i = 0; i < count; ++i) heights[pixels[i]] = found[i];
}

}  // namespace

double endMargin(const Scene& scene) {
  const Bounds bounds = computeBounds(scene);
  float largest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max({largest, std::abs(bounds.lower[axis]), std::abs(bounds.upper[axis])});
  }
  const float next = std::nextafter(largest, std::numeric_limits<float>::infinity());
  return kEndMarginUlps * (static_cast<double>(next) - static_cast<double>(largest));
}

LightRays::LightRays(const Scene& scene, const LightModel& light) : light_(light) {
  const Bounds bounds = computeBounds(scene);
  centerW_ = glm::dvec3(bounds.center());
  const double diagonal = bounds.diagonal();
  startOffset_ = diagonal > 0.0 ? diagonal : 1.0;
}

LightRay LightRays::towards(const glm::dvec3& pointW) const {
  if (light_.type == LightType::Directional) {
    const double distance = glm::dot(pointW - centerW_, light_.directionW) + startOffset_;
    return {{pointW - light_.directionW * distance, light_.directionW}, distance};
  }
  const glm::dvec3 toPoint = pointW - light_.positionW;
  const double distance = glm::length(toPoint);
  return {{light_.positionW, toPoint / distance}, distance};
}

RayD LightRays::normalized(const RayD& ray) const {
  if (light_.type != LightType::Directional) return {light_.positionW, ray.dir};
  const double distance = glm::dot(ray.origin - centerW_, ray.dir) + startOffset_;
  return {ray.origin - ray.dir * distance, ray.dir};
}

Truth computeTruth(const Tracer& tracer, const LightModel& light, const Receivers& receivers) {
  const size_t pixelCount = receivers.states.size();
  GNOMON_CHECK_EQ(pixelCount, receivers.samples.size());
  Truth truth;
  truth.margin = endMargin(tracer.scene());
  const auto begin = std::chrono::steady_clock::now();
  const LightRays rays(tracer.scene(), light);
  std::vector<double> heights(pixelCount, std::numeric_limits<double>::infinity());
  const int tileRows = (receivers.height + kTileSide - 1) / kTileSide;
  tbb::parallel_for(0, tileRows, [&](int row) {
    for (int x = 0; x < receivers.width; x += kTileSide) {
      traceTile(tracer, rays, receivers, x, row * kTileSide, 2.0 * truth.margin, heights);
    }
  });
  truth.lit.resize(pixelCount);
  for (size_t i = 0; i < pixelCount; ++i) {
    const bool lit = heights[i] <= truth.margin;
    truth.lit[i] = lit ? 1 : 0;
    truth.litCount += lit ? 1 : 0;
    truth.marginFlipsHalf += lit && heights[i] > 0.5 * truth.margin ? 1 : 0;
    truth.marginFlipsDouble += !lit && heights[i] <= 2.0 * truth.margin ? 1 : 0;
  }
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
  truth.traceMs = elapsed.count();
  return truth;
}

}  // namespace gnomon
