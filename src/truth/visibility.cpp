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

// What one row of tiles came to.
struct Tally {
  size_t lit = 0, flipsHalf = 0, flipsDouble = 0;
};

// Of the next tile's row. The rays between leave the processor no time to see where reading goes: a twelfth of the pass
// was waiting for it.
void prefetchSamples(const SurfaceSample* first) {
  for (size_t byte = 0; byte < kTileSide * sizeof(SurfaceSample); byte += 64)
    __builtin_prefetch(reinterpret_cast<const char*>(first) + byte);
}

// Traces one tile's scored pixels.
void traceTile(const Tracer& tracer, const LightModel& light, const LightRays& rays, const Receivers& receivers,
               int tileX, int tileY, double margin, std::vector<uint8_t>& lit, Tally& tally) {
  std::array<const SurfaceSample*, Tracer::kPacket> surfaces;
  std::array<size_t, Tracer::kPacket> pixels;
  std::array<double, Tracer::kPacket> heightsOf;
  size_t count = 0;
  for (int y = tileY; y < std::min(tileY + kTileSide, receivers.height); ++y) {
    const size_t row = static_cast<size_t>(y) * static_cast<size_t>(receivers.width);
    if (tileX + 2 * kTileSide <= receivers.width)
      prefetchSamples(&receivers.samples[row + static_cast<size_t>(tileX + kTileSide)]);
    for (int x = tileX; x < std::min(tileX + kTileSide, receivers.width); ++x) {
      const size_t pixel = row + static_cast<size_t>(x);
      if (receivers.states[pixel] != PixelState::Scored) continue;
      surfaces[count] = &receivers.samples[pixel];
      pixels[count++] = pixel;
    }
  }
  if (count == 0) return;
  const std::span<double> heights = std::span(heightsOf).first(count);
  if (light.type == LightType::Directional) {
    std::array<ShadowSegment, Tracer::kPacket> segments;
    for (size_t i = 0; i < count; ++i) {
      const LightRay towards = rays.towards(surfaces[i]->positionW);
      segments[i] = {towards.ray, towards.distance, surfaces[i]->primitive, surfaces[i]->normalW};
    }
    tracer.blockerHeights(std::span(segments).first(count), 2.0 * margin, heights);
  } else {
    tracer.blockerHeights(light.positionW, std::span(surfaces).first(count), 2.0 * margin, heights);
  }
  for (size_t i = 0; i < count; ++i) {
    const bool isLit = heights[i] <= margin;
    lit[pixels[i]] = isLit ? 1 : 0;
    tally.lit += isLit ? 1 : 0;
    tally.flipsHalf += isLit && heights[i] > 0.5 * margin ? 1 : 0;
    tally.flipsDouble += !isLit && heights[i] <= 2.0 * margin ? 1 : 0;
  }
}

}  // namespace

double endMargin(const Scene& scene) {
  return endMargin(computeBounds(scene));
}

double endMargin(const Bounds& sceneW) {
  float largest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max({largest, std::abs(sceneW.lower[axis]), std::abs(sceneW.upper[axis])});
  }
  const float next = std::nextafter(largest, std::numeric_limits<float>::infinity());
  return kEndMarginUlps * (static_cast<double>(next) - static_cast<double>(largest));
}

LightRays::LightRays(const Scene& scene, const LightModel& light) : LightRays(computeBounds(scene), light) {}

LightRays::LightRays(const Bounds& sceneW, const LightModel& light) : light_(light) {
  centerW_ = glm::dvec3(sceneW.center());
  const double diagonal = sceneW.diagonal();
  startOffset_ = diagonal > 0.0 ? diagonal : 1.0;
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
  truth.margin = endMargin(tracer.boundsW());
  const auto begin = std::chrono::steady_clock::now();
  const LightRays rays(tracer.boundsW(), light);
  truth.lit.resize(pixelCount);
  const int tileRows = (receivers.height + kTileSide - 1) / kTileSide;
  std::vector<Tally> tallies(static_cast<size_t>(tileRows));
  tbb::parallel_for(0, tileRows, [&](int row) {
    for (int x = 0; x < receivers.width; x += kTileSide)
      traceTile(tracer, light, rays, receivers, x, row * kTileSide, truth.margin, truth.lit,
                tallies[static_cast<size_t>(row)]);
  });
  for (const Tally& tally : tallies) {
    truth.litCount += tally.lit;
    truth.marginFlipsHalf += tally.flipsHalf;
    truth.marginFlipsDouble += tally.flipsDouble;
  }
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
  truth.traceMs = elapsed.count();
  return truth;
}

}  // namespace gnomon
