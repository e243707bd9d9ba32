#include "judge/filtered_truth.h"

#include "base/check.h"
#include "truth/continuity.h"

#include "shared/bias.glsl"

#include <array>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

static_assert(glsl::kKernelSamples == static_cast<int>(Tracer::kPacket));

// What all samples of a picture share.
struct Kernel {
  const Tracer& tracer;
  const FittedMap& fitted;
  const LightRays& rays;
  glm::dmat3 worldFromLight;
  double margin;
  const ChosenFilter& filter;
};

RayD rayToWorld(const Kernel& kernel, const glsl::Ray& ray) {
  return kernel.rays.normalized(
      {.origin = glm::dvec3(kernel.fitted.frame.originW) + kernel.worldFromLight * glm::dvec3(ray.origin),
       .dir = glm::normalize(kernel.worldFromLight * glm::dvec3(ray.dir))});
}

bool continuousWithReceiver(const Kernel& kernel, const SurfaceSample& sample, const RayD& ray) {
  const LightRay own = kernel.rays.towards(sample.positionW);
  const Probe pixel{own.ray, SurfaceHit{own.distance, sample.primitive, sample.normalW}};
  return continuousBetween(kernel.tracer, probeAlong(kernel.tracer, ray), pixel, kernel.margin);
}

float filteredPixel(const Kernel& kernel, const SurfaceSample& sample, bool lit, uint32_t seed) {
  const glsl::ShadowMap& map = kernel.fitted.map;
  const glsl::Receiver receiver{glsl::lightFromWorld(kernel.fitted.frame, glm::vec3(sample.positionW)),
                                glsl::directionFromWorld(kernel.fitted.frame, glm::vec3(sample.normalW))};
  const glsl::MapPoint point = glsl::mapProject(map, receiver.posL);
  if (!point.covered) return lit ? 1.0f : 0.0f;
  std::array<ShadowSegment, Tracer::kPacket> segments;
  size_t count = 0;
  int litCount = 0;
  for (int i = 0; i < glsl::kKernelSamples; ++i) {
    bool known = false;
    const glm::vec2 offset = glsl::kernelOffset(kernel.filter.id, kernel.filter.params, seed, i, known);
    GNOMON_CHECK(known);
    const glm::vec2 uv = point.uv + offset / glsl::mapTexelCounts(map);
    const glsl::Ray rayL = glsl::mapTexelRay(map, point.slice, uv);
    const RayD ray = rayToWorld(kernel, rayL);
    const double approach = glm::dot(sample.normalW, ray.dir);
    const double distance = glm::dot(sample.normalW, sample.positionW - ray.origin) / approach;
    if (!(approach < 0.0) || glsl::receiverPlaneDepth(map, point.slice, receiver, rayL).grazing)
      litCount += lit ? 1 : 0;
    else
      segments[count++] = {ray, distance, sample.primitive, sample.normalW};
  }
  std::array<double, Tracer::kPacket> heights;
  kernel.tracer.blockerHeights({segments.data(), count}, kernel.margin, {heights.data(), count});
  for (size_t i = 0; i < count; ++i)
    if (heights[i] <= kernel.margin || (lit && continuousWithReceiver(kernel, sample, segments[i].ray))) ++litCount;
  return static_cast<float>(litCount) / static_cast<float>(glsl::kKernelSamples);
}

}  // namespace

std::vector<float> computeFilteredTruth(const Tracer& tracer, const LightModel& light, const Receivers& receivers,
                                        const Truth& truth, const FittedMap& fitted, const ChosenFilter& filter) {
  const LightRays rays(tracer.scene(), light);
  const Kernel kernel{.tracer = tracer,
                      .fitted = fitted,
                      .rays = rays,
                      .worldFromLight = glm::dmat3(glm::dvec3(fitted.frame.rightW), glm::dvec3(fitted.frame.upW),
                                                   glm::dvec3(fitted.frame.backW)),
                      .margin = truth.margin,
                      .filter = filter};
  std::vector<float> visibility(truth.lit.size(), 0.0f);
  tbb::parallel_for(0, receivers.height, [&](int y) {
    for (int x = 0; x < receivers.width; ++x) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(receivers.width) + static_cast<size_t>(x);
      const bool lit = truth.lit[i] != 0;
      if (receivers.states[i] == PixelState::Empty)
        visibility[i] = 1.0f;
      else if (receivers.states[i] == PixelState::Scored)
        visibility[i] = filter.id == glsl::kShadowFilterNone
                            ? (lit ? 1.0f : 0.0f)
                            : filteredPixel(kernel, receivers.samples[i], lit, glsl::pixelSeed({x, y}));
    }
  });
  return visibility;
}

double scoredRmse(const Receivers& receivers, std::span<const float> visibility, std::span<const float> truth) {
  double sum = 0.0;
  for (size_t i = 0; i < truth.size(); ++i) {
    if (receivers.states[i] != PixelState::Scored) continue;
    const double difference = static_cast<double>(visibility[i]) - static_cast<double>(truth[i]);
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(receivers.scored));
}

}  // namespace gnomon
