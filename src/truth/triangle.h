#pragma once
// Ray-triangle intersection in double precision, which replaces Embree's float hits. Frame: W, metres.

#include "truth/tracer.h"

namespace gnomon {

// The point of a triangle where a ray meets it: shared/geometry.glsl's surfacePoint in double. The weights
// are clamped to the triangle, so that a ray that passes beside it by a rounding gets the nearest-by point of
// it and never one of its plane's extension, which at grazing angles lies anywhere.
struct TriangleMeeting {
  glm::dvec3 positionW{0.0};
  glm::dvec3 weights{1.0, 0.0, 0.0};  // of the three corners
  double distance = 0.0;              // metres along the ray to positionW
  bool edgeOn = false;                // the ray runs in the triangle's plane (or it has no area): nothing above holds
};
TriangleMeeting meetTriangle(const RayD& ray, const glm::dvec3 corners[3]);

// Unit, by the winding; zero where the triangle has no area.
glm::dvec3 triangleNormal(const glm::dvec3 corners[3]);

}  // namespace gnomon
