#include "truth/triangle.h"

namespace gnomon {

glm::dvec3 Triangle::normal() const {
  const double area = glm::length(scaledNormal);
  return area > 0.0 ? scaledNormal / area : glm::dvec3(0.0);
}

TriangleMeeting meetTriangle(const RayD& ray, const glm::dvec3 corners[3]) {
  return Triangle(corners).meet(ray);
}

glm::dvec3 triangleNormal(const glm::dvec3 corners[3]) {
  return Triangle(corners).normal();
}

}  // namespace gnomon
