#pragma once
// The exact shadow: one ray a scored pixel, from the light to the surface.

#include "truth/receivers.h"

#include <cstdint>
#include <vector>

namespace gnomon {

// How far in front of the receiver's plane a surface must lie to block it, metres along the receiver's normal.
// Positions are 32-bit floats: corners that were meant to lie in one plane lie within half an ulp of the largest
// coordinate of it. kEndMarginUlps of those cover a triangle's plane built from such corners.
inline constexpr double kEndMarginUlps = 8.0;
double endMargin(const Scene& scene, const LightModel& light);

struct Truth {
  std::vector<uint8_t> lit;  // one a pixel: 1 lit, 0 in shadow or not scored
  double margin = 0.0;       // metres
  size_t litCount = 0;
  // The instrument's own error: scored pixels that change when the margin is halved or doubled.
  size_t marginFlipsHalf = 0;
  size_t marginFlipsDouble = 0;
  double traceMs = 0.0;  // of the one pass at the nominal margin
};

// The ray from the light towards a point. A directional light's ray starts outside the scene's bounds.
struct LightRay {
  RayD ray;
  double distance = 0.0;  // metres to the point
};
class LightRays {
 public:
  LightRays(const Scene& scene, const LightModel& light);
  LightRay towards(const glm::dvec3& pointW) const;
  // The same line as `ray`, with its origin moved to where rays towards points start.
  RayD normalized(const RayD& ray) const;

 private:
  LightModel light_;
  glm::dvec3 centerW_{0.0};
  double startOffset_ = 0.0;  // metres from the centre's plane, directional lights
};

// All cores; deterministic.
Truth computeTruth(const Tracer& tracer, const LightModel& light, const Receivers& receivers);

}  // namespace gnomon
