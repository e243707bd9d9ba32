#include "reference_map.h"

#include <cmath>

#include <tbb/parallel_for.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::test {

namespace {

RayD worldRay(const ReferenceMap& map, glm::ivec2 texel) {
  const glsl::Ray ray = glsl::mapTexelRay(map.map, 0, glsl::mapTexelCenter(map.map, texel));
  return {glm::dvec3(ray.origin) + map.frameOriginW, glm::normalize(glm::dvec3(ray.dir))};
}

glm::dmat4 clipFromLight(const LightModel& light, const MapWindow& window, const glm::dvec3& frameOriginW) {
  const glm::dvec3 targetL = window.targetW - frameOriginW;
  const glm::dvec3 along = light.type == LightType::Directional ? light.directionW : glm::normalize(targetL);
  const glm::dvec3 up = std::abs(along.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  glm::dmat4 flipY(1.0);
  flipY[1][1] = -1.0;
  const double e = window.halfExtent;
  if (light.type == LightType::Directional) {
    const glm::dvec3 eyeL = targetL - along * (0.5 * window.far);
    return flipY * glm::orthoRH_ZO(-e, e, -e, e, window.near, window.far) * glm::lookAtRH(eyeL, targetL, up);
  }
  return flipY * glm::perspectiveRH_ZO(2.0 * std::atan(e), 1.0, window.near, window.far) *
         glm::lookAtRH(glm::dvec3(0.0), along, up);
}

}  // namespace

glm::dvec2 ReferenceMap::texelOf(const glm::dvec3& pointW) const {
  return glm::dvec2(glsl::mapProject(map, glm::vec3(pointW - frameOriginW)).uv) * static_cast<double>(map.width);
}

RayD ReferenceMap::texelRay(const glm::dvec3& pointW) const {
  return worldRay(*this, glsl::mapTexel(map, glsl::mapProject(map, glm::vec3(pointW - frameOriginW)).uv));
}

Verdict ReferenceMap::verdict(const SurfaceSample& sample, int method, const glsl::BiasParams& params) const {
  const glsl::Receiver receiver{glm::vec3(sample.positionW - frameOriginW), glm::vec3(sample.normalW)};
  const glsl::MapPoint point = glsl::mapProject(map, receiver.posL);
  if (!point.covered) return Verdict::Uncovered;
  const glm::ivec2 texel = glsl::mapTexel(map, point.uv);
  glsl::Tap tap = glsl::emptyTap(0, texel, glsl::mapTexelRay(map, 0, glsl::mapTexelCenter(map, texel)));
  tap.z1 = depths[static_cast<size_t>(tap.texel.y * map.width + tap.texel.x)];
  bool known = false;
  return glsl::biasLit(method, map, params, receiver, tap, known) ? Verdict::Lit : Verdict::Shadow;
}

ReferenceMap traceReferenceMap(const Tracer& tracer, const LightModel& light, const MapWindow& window) {
  ReferenceMap result;
  result.frameOriginW = light.type == LightType::Directional ? window.targetW : light.positionW;
  const glm::dmat4 clip = clipFromLight(light, window, result.frameOriginW);
  result.map = {};
  result.map.kind = glsl::kMapPlanar;
  result.map.sliceCount = 1;
  result.map.width = result.map.height = window.side;
  result.map.sceneScale = computeBounds(tracer.scene()).diagonal();
  result.map.mapSlices[0] = {glm::mat4(clip), glm::mat4(glm::inverse(clip))};
  result.depths.assign(static_cast<size_t>(window.side) * static_cast<size_t>(window.side), 1.0f);
  const LightRays rays(tracer.scene(), light);
  tbb::parallel_for(0, window.side, [&](int y) {
    for (int x = 0; x < window.side; ++x) {
      const RayD ray = rays.normalized(worldRay(result, {x, y}));
      const std::optional<SurfaceHit> hit = tracer.firstHit(ray);
      if (!hit) continue;
      const glm::dvec3 hitW = ray.origin + ray.dir * hit->distance;
      const float depth = glsl::mapDepth(result.map, 0, glm::vec3(hitW - result.frameOriginW));
      result.depths[static_cast<size_t>(y * window.side + x)] = std::min(depth, 1.0f);
    }
  });
  return result;
}

std::vector<Verdict> predict(const ReferenceMap& map, const Receivers& receivers, int method,
                             const glsl::BiasParams& params) {
  std::vector<Verdict> verdicts(receivers.states.size(), Verdict::NotAsked);
  for (size_t i = 0; i < verdicts.size(); ++i) {
    if (receivers.states[i] == PixelState::Scored) verdicts[i] = map.verdict(receivers.samples[i], method, params);
  }
  return verdicts;
}

glsl::BiasParams defaultBias(int method) {
  glsl::BiasParams params{.epsilonAt = glsl::kEpsilonAtOccluder};
  if (method == glsl::kBiasConstant) params.knobs[glsl::kConstantOffset] = 0.05f;
  if (method == glsl::kBiasSlope) params.knobs[glsl::kSlopeFactor] = 1.0f;
  if (method == glsl::kBiasAdaptive) params.knobs[glsl::kAdaptiveK] = 1e-4f;
  return params;
}

}  // namespace gnomon::test
