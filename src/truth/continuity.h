#pragma once
// The continuity test: whether the first-hit surface, seen from the light, is in one piece between two light rays, of a
// point light (one origin) or a directional light (one direction). Frame: W, metres.

#include "truth/tracer.h"

#include <optional>

namespace gnomon {

// A ray and what it hits first.
struct Probe {
  RayD ray;
  std::optional<SurfaceHit> hit;
  glm::dvec3 positionW() const { return ray.origin + ray.dir * hit->distance; }
};
Probe probeAlong(const Tracer& tracer, const RayD& ray);

// Halves the stretch with the largest jump kBisectionSteps times, to a thousandth of the whole, and judges
// there (continuity.cpp says how). Two hits on one triangle, on two that are one plane to within the margin,
// or on neighbours count as one piece whatever stands between: a map that holds the receiver's own surface
// has nothing to excuse it. Two rays that hit nothing count as one piece too.
inline constexpr int kBisectionSteps = 10;
bool continuousBetween(const Tracer& tracer, const RayD& a, const RayD& b, double margin);

// The same where the ends' hits are known already.
bool continuousBetween(const Tracer& tracer, const Probe& a, const Probe& b, double margin);

}  // namespace gnomon
