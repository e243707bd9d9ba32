#include "truth/triangle.h"

#include <algorithm>

namespace gnomon {

TriangleMeeting meetTriangle(const RayD& ray, const glm::dvec3 corners[3]) {
  const glm::dvec3 ab = corners[1] - corners[0];
  const glm::dvec3 ac = corners[2] - corners[0];
  const glm::dvec3 q = glm::cross(ray.origin - corners[0], ray.dir);
  const double determinant = -glm::dot(glm::cross(ab, ac), ray.dir);
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

glm::dvec3 triangleNormal(const glm::dvec3 corners[3]) {
  const glm::dvec3 scaled = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double area = glm::length(scaled);
  return area > 0.0 ? scaled / area : glm::dvec3(0.0);
}

}  // namespace gnomon
