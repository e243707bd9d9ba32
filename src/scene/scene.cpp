#include "scene/scene.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace gnomon {

namespace {

// Vertices at equal positions get equal numbers. -0 and +0 compare equal, as they must.
std::vector<uint32_t> weldPositions(const std::vector<glm::vec3>& positions) {
  std::vector<uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&](uint32_t a, uint32_t b) {
    const glm::vec3& p = positions[a];
    const glm::vec3& q = positions[b];
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    return p.z < q.z;
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<uint32_t> welded(positions.size());
  uint32_t id = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && less(order[i - 1], order[i])) ++id;
    welded[order[i]] = id;
  }
  return welded;
}

}  // namespace

uint64_t triangleCount(const Scene& scene) {
  uint64_t count = 0;
  for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].indices.size() / 3;
  return count;
}

Bounds computeBounds(const Scene& scene) {
  glm::vec3 lower(std::numeric_limits<float>::max());
  glm::vec3 upper(std::numeric_limits<float>::lowest());
  for (const Instance& instance : scene.instances) {
    const bool baked = instance.worldFromMesh == glm::mat4(1.0f);
    for (const glm::vec3& position : scene.meshes[instance.mesh].positions) {
      const glm::vec3 posW = baked ? position : glm::vec3(instance.worldFromMesh * glm::vec4(position, 1.0f));
      lower = glm::min(lower, posW);
      upper = glm::max(upper, posW);
    }
  }
  if (lower.x > upper.x) return {};
  return {lower, upper};
}

bool isSolid(const Scene& scene, const Mesh& mesh) {
  return mesh.closed && (mesh.solidAnyway || !scene.materials[mesh.material].doubleSided);
}

bool computeClosed(const Mesh& mesh) {
  const std::vector<uint32_t> welded = weldPositions(mesh.positions);
  // A directed edge is two vertex numbers in one word; closed means that each occurs once, and so does its reverse.
  std::vector<uint64_t> edges;
  edges.reserve(mesh.indices.size());
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint64_t v[3] = {welded[mesh.indices[i]], welded[mesh.indices[i + 1]], welded[mesh.indices[i + 2]]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (int k = 0; k < 3; ++k) edges.push_back(v[k] << 32 | v[(k + 1) % 3]);
  }
  if (edges.empty()) return false;
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  return std::all_of(edges.begin(), edges.end(), [&](uint64_t edge) {
    return std::binary_search(edges.begin(), edges.end(), edge >> 32 | edge << 32);
  });
}

Camera lookAt(std::string name, glm::vec3 eyeW, glm::vec3 targetW, float yFovRad) {
  const glm::dvec3 back = glm::normalize(glm::dvec3(eyeW) - glm::dvec3(targetW));
  // Within about 0.06 degrees of the vertical, +y no longer says which way is up.
  const bool vertical = std::abs(back.y) > 1.0 - 5e-7;
  const glm::dvec3 right = glm::normalize(glm::cross(vertical ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0), back));
  const glm::dvec3 up = glm::cross(back, right);
  Camera camera;
  camera.name = std::move(name);
  camera.worldFromEye = glm::mat4(glm::vec4(glm::vec3(right), 0.0f), glm::vec4(glm::vec3(up), 0.0f),
                                  glm::vec4(glm::vec3(back), 0.0f), glm::vec4(eyeW, 1.0f));
  camera.yFovRad = yFovRad;
  return camera;
}

}  // namespace gnomon
