#include "scenes_by_hand.h"

#include <array>
#include <cmath>
#include <numbers>

namespace gnomon::test {

namespace {

int addMesh(Scene& scene, const std::vector<glm::dvec3>& positions, std::vector<uint32_t> indices) {
  Mesh mesh;
  for (const glm::dvec3& position : positions) mesh.positions.emplace_back(position);
  mesh.normals.assign(positions.size(), glm::vec3(0.0f, 1.0f, 0.0f));
  mesh.uvs.assign(positions.size(), glm::vec2(0.0f));
  mesh.indices = std::move(indices);
  scene.meshes.push_back(std::move(mesh));
  return addInstance(scene, static_cast<int>(scene.meshes.size()) - 1, glm::mat4(1.0f));
}

}  // namespace

Scene emptyScene() {
  Scene scene;
  scene.name = "by hand";
  scene.materials.emplace_back();
  return scene;
}

int addInstance(Scene& scene, int mesh, const glm::mat4& worldFromMesh) {
  Instance instance;
  instance.mesh = mesh;
  instance.worldFromMesh = worldFromMesh;
  scene.instances.push_back(instance);
  return static_cast<int>(scene.instances.size()) - 1;
}

int addTriangle(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  return addMesh(scene, {a, b, c}, {0, 1, 2});
}

int addQuad(Scene& scene, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d) {
  const int instance = addMesh(scene, {a, b, c, d}, {0, 1, 2, 0, 2, 3});
  scene.meshes.back().uvs = {{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}};
  return instance;
}

int addFloor(Scene& scene, double y, double halfExtent) {
  const double e = halfExtent;
  return addQuad(scene, {-e, y, e}, {e, y, e}, {e, y, -e}, {-e, y, -e});
}

int addBox(Scene& scene, glm::dvec3 lower, glm::dvec3 upper) {
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z);
  }
  // Counter-clockwise seen from outside: -x +x -y +y -z +z.
  return addMesh(scene, corners, {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6});
}

int addSphere(Scene& scene, glm::dvec3 center, double radius, int rings, int segments) {
  std::vector<glm::dvec3> positions;
  for (int ring = 0; ring <= rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int segment = 0; segment < segments; ++segment) {
      const double azimuth = 2.0 * std::numbers::pi * segment / segments;
      positions.push_back(center + radius * glm::dvec3(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                                       std::sin(polar) * std::sin(azimuth)));
    }
  }
  std::vector<uint32_t> indices;
  for (int ring = 0; ring < rings; ++ring) {
    for (int segment = 0; segment < segments; ++segment) {
      const auto at = [&](int r, int s) { return static_cast<uint32_t>(r * segments + s % segments); };
      for (const uint32_t index : {at(ring, segment), at(ring, segment + 1), at(ring + 1, segment + 1),
                                   at(ring, segment), at(ring + 1, segment + 1), at(ring + 1, segment)}) {
        indices.push_back(index);
      }
    }
  }
  return addMesh(scene, positions, std::move(indices));
}

void moveAll(Scene& scene, const glm::dmat4& newFromOld) {
  for (Mesh& mesh : scene.meshes) {
    for (glm::vec3& position : mesh.positions) {
      position = glm::vec3(newFromOld * glm::dvec4(glm::dvec3(position), 1.0));
    }
  }
}

int addMaskMaterial(Scene& scene) {
  const uint32_t opaque = 0xffffffffu;
  const uint32_t hole = 0x00ffffffu;
  glsl::TextureInfo texture{};
  texture.firstTexel = static_cast<uint32_t>(scene.texels.size());
  texture.width = 2;
  texture.height = 2;
  texture.wrapS = glsl::kWrapClamp;
  texture.wrapT = glsl::kWrapClamp;
  texture.filterMode = glsl::kTexFilterNearest;
  scene.texels.insert(scene.texels.end(), {hole, opaque, opaque, opaque});
  scene.textures.push_back(texture);
  Material material;
  material.alphaMode = AlphaMode::Mask;
  material.baseColorTexture = static_cast<int>(scene.textures.size()) - 1;
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

}  // namespace gnomon::test
