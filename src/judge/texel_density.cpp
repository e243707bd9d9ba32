#include "judge/texel_density.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

// Where the ray through uv meets the receiver's plane, which lies before the light only if the distance is positive.
std::optional<glm::dvec3> meetPlane(const FittedMap& fitted, int slice, const glm::dvec2& uv,
                                    const glm::dvec3& positionL, const glm::dvec3& normalL) {
  const glsl::Ray ray = glsl::mapTexelRay(fitted.map, slice, glm::vec2(uv));
  const double approach = glm::dot(normalL, glm::dvec3(ray.dir));
  const double distance = glm::dot(normalL, positionL - glm::dvec3(ray.origin)) / approach;
  if (!(distance > 0.0) || !std::isfinite(distance)) return std::nullopt;
  return glm::dvec3(ray.origin) + glm::dvec3(ray.dir) * distance;
}

}  // namespace

std::optional<double> texelDensity(const FittedMap& fitted, const glm::dvec3& positionW, const glm::dvec3& normalW) {
  const glm::vec3 posL = glsl::lightFromWorld(fitted.frame, glm::vec3(positionW));
  const glm::dvec3 normalL(glsl::directionFromWorld(fitted.frame, glm::vec3(normalW)));
  const glsl::MapPoint point = glsl::mapProject(fitted.map, posL);
  if (!point.covered) return std::nullopt;
  const double half = 0.5 / fitted.map.width;
  glm::dvec3 edges[2];
  for (int axis = 0; axis < 2; ++axis) {
    glm::dvec2 step(0.0);
    step[axis] = half;
    const auto after = meetPlane(fitted, point.slice, glm::dvec2(point.uv) + step, glm::dvec3(posL), normalL);
    const auto before = meetPlane(fitted, point.slice, glm::dvec2(point.uv) - step, glm::dvec3(posL), normalL);
    if (!after || !before) return 0.0;
    edges[axis] = *after - *before;
  }
  const double area = glm::length(glm::cross(edges[0], edges[1]));
  return area > 0.0 ? 1.0 / area : 0.0;
}

std::vector<float> texelDensities(const FittedMap& fitted, const Receivers& receivers) {
  std::vector<float> densities(receivers.states.size(), -1.0f);
  tbb::parallel_for(0, receivers.height, [&](int y) {
    for (int x = 0; x < receivers.width; ++x) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(receivers.width) + static_cast<size_t>(x);
      if (receivers.states[i] != PixelState::Scored) continue;
      const SurfaceSample& sample = receivers.samples[i];
      if (const auto density = texelDensity(fitted, sample.positionW, sample.normalW))
        densities[i] = static_cast<float>(*density);
    }
  });
  return densities;
}

double medianDensity(std::span<const float> densities) {
  std::vector<float> known;
  std::ranges::copy_if(densities, std::back_inserter(known), [](float d) { return d >= 0.0f; });
  if (known.empty()) return 0.0;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  return static_cast<double>(*middle);
}

}  // namespace gnomon
