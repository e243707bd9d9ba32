#include "planar/convex_body.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

using Face = std::vector<glm::dvec3>;

// Sutherland and Hodgman 1974. The points made on the plane go to `rim` too.
Face cutFace(const Face& face, const glm::dvec3& normal, double offset, Face& rim) {
  Face kept;
  for (size_t i = 0; i < face.size(); ++i) {
    const glm::dvec3& p = face[i];
    const glm::dvec3& q = face[(i + 1) % face.size()];
    const double sideP = glm::dot(normal, p) + offset;
    const double sideQ = glm::dot(normal, q) + offset;
    if (sideP >= 0.0) kept.push_back(p);
    if ((sideP >= 0.0) == (sideQ >= 0.0)) continue;
    kept.push_back(p + (q - p) * (sideP / (sideP - sideQ)));
    rim.push_back(kept.back());
  }
  return kept;
}

// The rim's points lie on a convex polygon, in no order.
Face closeRim(Face rim, const glm::dvec3& normal) {
  glm::dvec3 center(0.0);
  for (const glm::dvec3& p : rim) center += p / static_cast<double>(rim.size());
  const glm::dvec3 hint = std::abs(normal.x) < 0.6 * glm::length(normal) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(normal, hint));
  const glm::dvec3 v = glm::normalize(glm::cross(normal, u));
  const auto angle = [&](const glm::dvec3& p) { return std::atan2(glm::dot(v, p - center), glm::dot(u, p - center)); };
  std::ranges::sort(rim, {}, angle);
  return rim;
}

}  // namespace

ConvexBody::ConvexBody(const Bounds& box) {
  const glm::dvec3 corner[2] = {glm::dvec3(box.lower), glm::dvec3(box.upper)};
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const glm::dvec3& fixed : corner) {
      Face face;
      for (const auto& [i, j] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
        glm::dvec3 p = fixed;
        p[u] = corner[i][u];
        p[v] = corner[j][v];
        face.push_back(p);
      }
      faces_.push_back(face);
    }
  }
}

void ConvexBody::cut(const glm::dvec3& normal, double offset) {
  Face rim;
  std::vector<Face> kept;
  for (const Face& face : faces_) {
    Face part = cutFace(face, normal, offset, rim);
    if (!part.empty()) kept.push_back(std::move(part));
  }
  if (rim.size() >= 3) kept.push_back(closeRim(std::move(rim), normal));
  faces_ = std::move(kept);
}

void ConvexBody::cutToCamera(const glsl::CameraView& camera, double nearest, double farthest) {
  const glm::dvec3 eye(camera.eyeW);
  const glm::dvec3 forward(camera.forwardW);
  const auto cutThroughEye = [&](const glm::dvec3& normal) { cut(normal, -glm::dot(normal, eye)); };
  for (const double sign : {1.0, -1.0}) {
    cutThroughEye(forward * static_cast<double>(camera.tanHalfX) + sign * glm::dvec3(camera.rightW));
    cutThroughEye(forward * static_cast<double>(camera.tanHalfY) + sign * glm::dvec3(camera.upW));
  }
  cut(forward, -glm::dot(forward, eye) - nearest);
  cut(-forward, glm::dot(forward, eye) + farthest);
}

std::vector<glm::dvec3> ConvexBody::corners() const {
  std::vector<glm::dvec3> all;
  for (const Face& face : faces_) all.insert(all.end(), face.begin(), face.end());
  return all;
}

double viewDepth(const glsl::CameraView& camera, const glm::dvec3& posW) {
  return glm::dot(glm::dvec3(camera.forwardW), posW - glm::dvec3(camera.eyeW));
}

}  // namespace gnomon
