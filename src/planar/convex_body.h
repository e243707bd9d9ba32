#pragma once
// A convex polyhedron, clipped by planes: the part of the scene's bounds in a camera's frustum or a spot's cone.

#include "scene/scene.h"

#include "shared/scene.glsl"

#include <vector>

#include <glm/glm.hpp>

namespace gnomon {

class ConvexBody {
 public:
  explicit ConvexBody(const Bounds& box);

  // Keeps the part where dot(normal, p) + offset >= 0.
  void cut(const glm::dvec3& normal, double offset);

  // Keeps what a camera sees at view depths from `nearest` to `farthest`, metres along its axis.
  void cutToCamera(const glsl::CameraView& camera, double nearest, double farthest);

  // Corners, some of them more than once; none where nothing is left.
  std::vector<glm::dvec3> corners() const;

 private:
  std::vector<std::vector<glm::dvec3>> faces_;
};

// Metres in front of the camera, along its axis.
double viewDepth(const glsl::CameraView& camera, const glm::dvec3& posW);

}  // namespace gnomon
