#pragma once
// The exact shadow: one ray for each scored pixel, from the light to the surface.

#include "truth/receivers.h"

#include <cstdint>
#include <vector>

namespace gnomon {

// How far in front of the receiver's plane a surface must lie to block it, metres along the receiver's
// normal, in ulps of the largest coordinate of the scene.
//
// Positions are 32-bit floats. A corner that was meant to lie in a plane is moved by at most half an ulp
// along each axis, so by at most sqrt(3)/2 = 0.87 ulps along any normal. Inside a triangle the error of its
// plane is a weighted mean of its corners' errors and no larger. Two triangles that were meant to be one
// surface (z-fighting pairs, the halves of a quad, a box on the floor) are thus at most 1.73 ulps apart where
// they overlap; twice that, 3.5, where the modeller rounded in its own frame and the loader rounded again in
// the world's. The receiver's plane is extrapolated only as far as a blocker within the margin can lie from
// the point it shadows, and the receiver's triangle is clamped to, so that extrapolation adds its share,
// margin * tan(angle of incidence) / (the triangle's height), and matters for slivers only. 8 is 3.5 with a
// reserve of two, so that half the margin is still above the rounding: a pixel that changes when the margin
// is halved is a real surface nearer than 8 ulps to another, or a sliver.
inline constexpr double kEndMarginUlps = 8.0;
double endMargin(const Scene& scene);
double endMargin(const Bounds& sceneW);

struct Truth {
  std::vector<uint8_t> lit;  // one a pixel: 1 lit, 0 in shadow or not scored
  double margin = 0.0;       // metres
  size_t litCount = 0;
  // The instrument's own error: scored pixels that change when the margin is halved or doubled.
  size_t marginFlipsHalf = 0;
  size_t marginFlipsDouble = 0;
  double traceMs = 0.0;  // of the one pass that decides at all three margins
};

// The ray from the light towards a point. A directional light's ray starts outside the scene's bounds.
struct LightRay {
  RayD ray;
  double distance = 0.0;  // metres to the point
};
class LightRays {
 public:
  LightRays(const Scene& scene, const LightModel& light);
  LightRays(const Bounds& sceneW, const LightModel& light);
  LightRay towards(const glm::dvec3& pointW) const;
  // The same line as `ray`, with its origin moved to where rays towards points start.
  RayD normalized(const RayD& ray) const;

 private:
  LightModel light_;
  glm::dvec3 centerW_{0.0};
  double startOffset_ = 0.0;  // metres from the centre's plane, directional lights
};

inline LightRay LightRays::towards(const glm::dvec3& pointW) const {
  if (light_.type == LightType::Directional) {
    const double distance = glm::dot(pointW - centerW_, light_.directionW) + startOffset_;
    return {{pointW - light_.directionW * distance, light_.directionW}, distance};
  }
  const glm::dvec3 toPoint = pointW - light_.positionW;
  const double distance = glm::length(toPoint);
  return {{light_.positionW, toPoint / distance}, distance};
}

// All cores; deterministic.
Truth computeTruth(const Tracer& tracer, const LightModel& light, const Receivers& receivers);

}  // namespace gnomon
