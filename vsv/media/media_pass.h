#pragma once
// Single scattering of a point light in a medium, on the GPU: light shafts from the bits of a shadow volume,
// or by marching through a shadow map. The model is in shaders/shared/medium.glsl.

#include "scene/gbuffer.h"
#include "vsv/shadow_volume.h"

#include "shared/medium.glsl"

namespace gnomon {

// How the integral along a view ray is taken.
enum class Integrator {
  Runs,      // runs of lit bits, each the difference of two values of the running integral
  Bits,      // the integral over one bit, summed over the lit bits
  Popcount,  // the whole integral times the share of bits that are lit
  March,     // samples at equal distances, each looked up in a shadow map
};
Integrator parseIntegrator(const std::string& name);  // runs, bits, popcount, march. Throws UsageError.
const char* integratorName(Integrator integrator);

struct MediaMethod {
  Integrator integrator = Integrator::Runs;
  int steps =
      0;  // of March; and of every integrator in a heterogeneous medium, where the view ray is marched
};

struct MediaLightSource {
  glm::dvec3 positionW{0.0};
  glm::vec3 intensity{1.0f};  // candela, a colour channel each
};

}  // namespace gnomon
