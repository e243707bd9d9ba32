#pragma once
// An exact shadow map on the CPU: its texels are traced through mapTexelRay, and its verdicts are biasLit's.
// What is left to be wrong at a pixel is the bias and the resolution, which is what labels tell apart.

#include "truth/labels.h"

#include "shared/bias.glsl"

#include <vector>

#include <glm/glm.hpp>

namespace gnomon::test {

struct ReferenceMap {
  glsl::ShadowMap map;
  glm::dvec3 frameOriginW{0.0};  // L has W's axes, and its origin here
  std::vector<float> depths;     // side * side, 1 where nothing was hit

  // Where a point falls, in texels.
  glm::dvec2 texelOf(const glm::dvec3& pointW) const;
  RayD texelRay(const glm::dvec3& pointW) const;
  Verdict verdict(const SurfaceSample& sample, int method, const glsl::BiasParams& params) const;
};

struct MapWindow {
  glm::dvec3 targetW{0.0};  // the centre of the map
  double halfExtent = 1.0;  // directional: metres; spot: tangent of the half angle
  int side = 64;            // texels
  double near = 0.5;        // metres from the light, or from `far / 2` before the target of a directional map
  double far = 20.0;
};
ReferenceMap traceReferenceMap(const Tracer& tracer, const LightModel& light, const MapWindow& window);

std::vector<Verdict> predict(const ReferenceMap& map, const Receivers& receivers, int method,
                             const glsl::BiasParams& params);

// The defaults of the design: K = 1e-4 at the occluder.
glsl::BiasParams defaultBias(int method);

}  // namespace gnomon::test
