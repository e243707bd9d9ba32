#pragma once
// Ray-triangle intersection in double precision, which replaces Embree's float hits. Frame: W, metres.

#include "truth/tracer.h"

#include <algorithm>

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

// A triangle made ready for many rays: neighbouring pixels see the same one.
struct Triangle {
  glm::dvec3 corners[3];
  glm::dvec3 ab, ac;
  glm::dvec3 scaledNormal;  // by the winding; as long as twice the area

  explicit Triangle(const glm::dvec3 at[3])
      : corners{at[0], at[1], at[2]}, ab(at[1] - at[0]), ac(at[2] - at[0]), scaledNormal(glm::cross(ab, ac)) {}

  TriangleMeeting meet(const RayD& ray) const {
    const glm::dvec3 q = glm::cross(ray.origin - corners[0], ray.dir);
    const double determinant = -glm::dot(scaledNormal, ray.dir);
    TriangleMeeting meeting;
    meeting.edgeOn = determinant == 0.0;
    if (meeting.edgeOn) return meeting;
    const double v = std::clamp(glm::dot(ac, q) / determinant, 0.0, 1.0);
    const double w = std::clamp(-glm::dot(ab, q) / determinant, 0.0, 1.0 - v);
    meeting.weights = {1.0 - v - w, v, w};
    meeting.positionW = corners[0] * meeting.weights.x + corners[1] * v + corners[2] * w;
    meeting.distance = glm::dot(meeting.positionW - ray.origin, ray.dir);
    return meeting;
  }

  // Unit, by the winding; zero where the triangle has no area.
  glm::dvec3 normal() const;
};

TriangleMeeting meetTriangle(const RayD& ray, const glm::dvec3 corners[3]);

// Unit, by the winding; zero where the triangle has no area.
glm::dvec3 triangleNormal(const glm::dvec3 corners[3]);

}  // namespace gnomon
