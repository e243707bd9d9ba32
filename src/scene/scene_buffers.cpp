#include "scene/scene_buffers.h"

#include "base/error.h"
#include "scene/mesh_links.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

glsl::SceneMaterial toGpu(const Material& material) {
  return {.baseColor = material.baseColor,
          .alphaCutoff = material.alphaCutoff,
          .texture = material.baseColorTexture,
          .alphaMask = material.alphaMode == AlphaMode::Mask ? 1 : 0,
          .doubleSided = material.doubleSided ? 1 : 0};
}

Bounds instanceBounds(const Mesh& mesh, const glm::mat4& worldFromMesh) {
  Bounds bounds{.lower = glm::vec3(INFINITY), .upper = glm::vec3(-INFINITY)};
  for (const glm::vec3& position : mesh.positions) {
    const glm::vec3 posW(worldFromMesh * glm::vec4(position, 1.0f));
    bounds.lower = glm::min(bounds.lower, posW);
    bounds.upper = glm::max(bounds.upper, posW);
  }
  return bounds;
}

// Of the parts of a large mesh, in its own space; none of a small one.
std::vector<Bounds> partBounds(const Mesh& mesh) {
  std::vector<Bounds> parts;
  if (mesh.indices.size() < kLeastPartedIndices) return parts;
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    if (i % kPartIndices == 0) parts.push_back({.lower = glm::vec3(INFINITY), .upper = glm::vec3(-INFINITY)});
    const glm::vec3& position = mesh.positions[mesh.indices[i]];
    parts.back().lower = glm::min(parts.back().lower, position);
    parts.back().upper = glm::max(parts.back().upper, position);
  }
  return parts;
}

// Before anything is uploaded, since it takes a while.
void checkSize(const gpu::Device& device, const Scene& scene) {
  uint64_t vertices = 0, triangles = 0;
  for (const Mesh& mesh : scene.meshes) {
    vertices += mesh.positions.size();
    triangles += mesh.indices.size() / 3;
  }
  const uint64_t largest = sizeof(glm::vec3) * std::max(vertices, triangles);  // a position; a triangle's corners
  const uint64_t allowed = device.info().maxStorageBufferBytes;
  if (largest <= allowed) return;
  throw WorldError(
      fmt::format("{} triangles with {} vertices need a buffer of {:.0f} MiB, and the largest of '{}' has {:.0f} MiB; "
                  "use fewer triangles, or meshes that are placed more than once",
                  triangles, vertices, static_cast<double>(largest) / (1 << 20), device.info().name,
                  static_cast<double>(allowed) / (1 << 20)));
}

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& some) {
  all.insert(all.end(), some.begin(), some.end());
}

}  // namespace

Bounds placedBounds(const glm::mat4& worldFromMesh, const Bounds& bounds) {
  const glm::vec3 center(worldFromMesh * glm::vec4(0.5f * (bounds.lower + bounds.upper), 1.0f));
  const glm::vec3 half = 0.5f * (bounds.upper - bounds.lower);
  glm::vec3 reach(0.0f);
  for (int axis = 0; axis < 3; ++axis) reach += glm::abs(glm::vec3(worldFromMesh[axis])) * half[axis];
  return {.lower = center - reach, .upper = center + reach};
}

SceneBuffers createSceneBuffers(const gpu::Device& device, const Scene& scene) {
  checkSize(device, scene);
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<uint32_t> indices;
  std::vector<uint32_t> firstIndices;      // one a mesh
  std::vector<std::vector<Bounds>> parts;  // of each mesh
  for (const Mesh& mesh : scene.meshes) {
    firstIndices.push_back(static_cast<uint32_t>(indices.size()));
    const auto firstVertex = static_cast<uint32_t>(positions.size());
    for (const uint32_t index : mesh.indices) indices.push_back(firstVertex + index);
    append(positions, mesh.positions);
    parts.push_back(partBounds(mesh));
    append(normals, mesh.normals);
    normals.resize(positions.size(), glm::vec3(0.0f));  // a flat mesh's: shaders take the triangle's
    append(uvs, mesh.uvs);
  }

  SceneBuffers buffers;
  std::vector<uint32_t> triangleCounts;  // of each instance
  std::vector<bool> used(scene.meshes.size(), false);
  std::vector<glsl::SceneInstance> instances;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Material& material = scene.materials[mesh.material];
    const uint32_t firstIndex = firstIndices[instance.mesh];
    const bool mirrored = glm::determinant(glm::mat3(instance.worldFromMesh)) < 0.0f;
    buffers.draws.push_back({.indexCount = static_cast<uint32_t>(mesh.indices.size()),
                             .firstIndex = firstIndex,
                             .instance = static_cast<uint32_t>(instances.size()),
                             .masked = material.alphaMode == AlphaMode::Mask,
                             .doubleSided = material.doubleSided,
                             .solid = isSolid(scene, mesh),
                             .casts = instance.casts,
                             .mirrored = mirrored,
                             .worldFromMesh = instance.worldFromMesh,
                             .material = toGpu(material),
                             .boundsW = instanceBounds(mesh, instance.worldFromMesh),
                             .firstPart = static_cast<uint32_t>(buffers.partBoundsW.size()),
                             .partCount = static_cast<uint32_t>(parts[instance.mesh].size())});
    for (const Bounds& part : parts[instance.mesh])
      buffers.partBoundsW.push_back(placedBounds(instance.worldFromMesh, part));
    instances.push_back({.worldFromMesh = instance.worldFromMesh,
                         .firstTriangle = firstIndex / 3,
                         .material = static_cast<uint32_t>(mesh.material),
                         .firstId = 0});
    triangleCounts.push_back(static_cast<uint32_t>(mesh.indices.size() / 3));
    buffers.firstTriangles.push_back(firstIndex / 3);
    buffers.instanced = buffers.instanced || used[instance.mesh] || instance.worldFromMesh != glm::mat4(1.0f);
    used[instance.mesh] = true;
  }
  std::ranges::stable_sort(buffers.draws, {}, &Draw::masked);
  const MeshLinks links = linkMeshes(scene, buffers.instanced);
  // Where they do not fit there are none: VisibilityPass says so to who needs them.
  const bool fit = links.rows.size() <= device.info().maxTexelBufferElements;
  buffers.meshRows = gpu::createTexelsWith(device, "mesh rows", VK_FORMAT_R32G32B32A32_UINT,
                                           fit ? links.rows : std::vector<glsl::MeshRow>());
  buffers.triangleFacts = gpu::createBufferWith(device, "triangle facts", links.facts);
  buffers.endMargin = receiverMargin(computeBounds(scene));
  buffers.ids = numberTriangles(triangleCounts, buffers.firstTriangles, buffers.instanced);
  for (size_t i = 0; i < instances.size(); ++i) instances[i].firstId = buffers.ids.firstIds[i];
  buffers.idChunks = gpu::createBufferWith(device, "id chunks", buffers.ids.chunks);

  std::vector<glsl::SceneMaterial> materials;
  for (const Material& material : scene.materials) {
    materials.push_back(toGpu(material));
    buffers.textured = buffers.textured || material.baseColorTexture >= 0;
    buffers.masked = buffers.masked || material.alphaMode == AlphaMode::Mask;
  }

  constexpr VkBufferUsageFlags kVertices = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
  buffers.positions = gpu::createBufferWith(device, "positions", positions, kVertices);
  buffers.normals = gpu::createBufferWith(device, "normals", normals, kVertices);
  buffers.uvs = gpu::createBufferWith(device, "uvs", uvs, kVertices);
  buffers.triangles = gpu::createBufferWith(device, "triangles", indices,
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  buffers.instances = gpu::createBufferWith(device, "instances", instances);
  buffers.materials = gpu::createBufferWith(device, "materials", materials);
  buffers.textures = gpu::createBufferWith(device, "textures", scene.textures);
  buffers.texels = gpu::createBufferWith(device, "texels", scene.texels);
  return buffers;
}

}  // namespace gnomon
