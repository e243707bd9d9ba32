#include "judge/light_place.h"

#include <algorithm>

namespace gnomon {

namespace {

constexpr double kRounding = 0x1p-21;

// Whether p lies in the triangle's plane, and within it, to `metres`.
bool isOn(const glm::dvec3 corners[3], const glm::dvec3& p, double metres) {
  const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double size = glm::length(normal);
  if (!(size > 0.0) || std::abs(glm::dot(normal, p - corners[0])) > metres * size) return false;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 side = corners[(i + 1) % 3] - corners[i];
    if (glm::dot(glm::cross(normal, side), p - corners[i]) < -metres * size * glm::length(side)) return false;
  }
  return true;
}

}  // namespace

std::optional<std::string> surfaceThroughLight(const Scene& scene, const Light& light) {
  if (light.type == LightType::Directional) return std::nullopt;
  const double metres = kRounding * computeBounds(scene).diagonal();
  const glm::dvec3 p(light.positionW);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const glm::dmat4 worldFromMesh(instance.worldFromMesh);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      glm::dvec3 corners[3];
      for (size_t k = 0; k < 3; ++k)
        corners[k] = glm::dvec3(worldFromMesh * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[i + k]]), 1.0));
      if (isOn(corners, p, metres)) return instance.name;
    }
  }
  return std::nullopt;
}

}  // namespace gnomon
