#include "judge/light_place.h"

#include <algorithm>

#include <tbb/parallel_for.h>

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

// The box around the mesh's, placed, and a hair more: whether the light is in it.
bool mayTouch(const Bounds& meshBounds, const glm::dmat4& worldFromMesh, const glm::dvec3& p, double metres) {
  const glm::dvec3 half = 0.5 * glm::dvec3(meshBounds.upper - meshBounds.lower);
  const glm::dvec3 center(worldFromMesh * glm::dvec4(glm::dvec3(meshBounds.lower) + half, 1.0));
  glm::dvec3 reach(metres);
  for (int axis = 0; axis < 3; ++axis) reach += glm::abs(glm::dvec3(worldFromMesh[axis])) * half[axis];
  return glm::all(glm::lessThanEqual(glm::abs(p - center), 1.0001 * reach));
}

}  // namespace

LightPlaces::LightPlaces(const Scene& scene)
    : scene_(scene), metres_(kRounding * static_cast<double>(computeBounds(scene).diagonal())) {
  meshBounds_.resize(scene.meshes.size());
  tbb::parallel_for(size_t{0}, scene.meshes.size(), [&](size_t i) {
    const std::vector<glm::vec3>& positions = scene.meshes[i].positions;
    if (positions.empty()) return;
    Bounds bounds{.lower = positions.front(), .upper = positions.front()};
    for (const glm::vec3& position : positions) {
      bounds.lower = glm::min(bounds.lower, position);
      bounds.upper = glm::max(bounds.upper, position);
    }
    meshBounds_[i] = bounds;
  });
}

std::optional<std::string> LightPlaces::surfaceThrough(const Light& light) const {
  if (light.type == LightType::Directional) return std::nullopt;
  const glm::dvec3 p(light.positionW);
  for (const Instance& instance : scene_.instances) {
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const glm::dmat4 worldFromMesh(instance.worldFromMesh);
    if (!instance.casts || !mayTouch(meshBounds_[instance.mesh], worldFromMesh, p, metres_)) continue;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      glm::dvec3 corners[3];
      for (size_t k = 0; k < 3; ++k)
        corners[k] = glm::dvec3(worldFromMesh * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[i + k]]), 1.0));
      if (isOn(corners, p, metres_)) return instance.name;
    }
  }
  return std::nullopt;
}

}  // namespace gnomon
