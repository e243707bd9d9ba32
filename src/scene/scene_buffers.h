#pragma once
// A scene on the GPU: the tables of shared/scene.glsl, and the list of draws.

#include "gpu/commands.h"
#include "scene/scene.h"
#include "scene/triangle_ids.h"

#include "shared/scene.glsl"

#include <vector>

namespace gnomon {

// Where a mesh's corners are read as vertex attributes, instead of from SceneBuffers::positions and triangles: somebody
// else's buffers.
struct VertexSource {
  gpu::Buffer vertices, indices;
  VkDeviceSize vertexOffset = 0, indexOffset = 0;  // bytes, of the first vertex's position and of the first index
  VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;    // of a position
  uint32_t stride = 12;                            // bytes
  VkIndexType indexType = VK_INDEX_TYPE_UINT32;
  uint32_t firstIndex = 0;  // that Draw::firstIndex stands for
};

// One instance's triangles. gl_InstanceIndex names the instance, gl_PrimitiveID counts from 0.
struct Draw {
  uint32_t indexCount = 0;
  uint32_t firstIndex = 0;
  uint32_t instance = 0;
  bool masked = false;       // needs the alpha test
  bool doubleSided = false;  // the camera sees both sides
  bool solid = false;        // closed and not doubleSided: its back faces may be culled from a map
  bool casts = true;         // into maps; else the camera alone draws it
  bool mirrored = false;     // the instance's matrix turns the winding round
  glm::mat4 worldFromMesh{1.0f};
  glsl::SceneMaterial material{};
  Bounds boundsW;          // metres
  uint32_t firstPart = 0;  // in SceneBuffers::partBoundsW
  uint32_t partCount = 0;  // 0: not cut in parts
  const VertexSource* source = nullptr;
};

// A large draw is cut in parts of as many indices, the last one less, so that a map's slice need not draw
// what it cannot see. A level that is one mesh of 21,236 triangles goes to a cube's six faces as 6.0 times
// that, in parts of 64 triangles as 2.2 times, triangle by triangle as 1.06 times; the map costs 5% less in
// parts, and 9% less triangle by triangle before the cost of writing six lists for every map.
inline constexpr uint32_t kPartIndices = 3 * 64;
// Fewer are drawn whole.
inline constexpr uint32_t kLeastPartedIndices = 8 * kPartIndices;

struct SceneBuffers {
  gpu::Buffer positions, triangles, instances, uvs, materials, textures, texels, normals;
  std::vector<Draw> draws;               // opaque first
  std::vector<Bounds> partBoundsW;       // metres
  std::vector<uint32_t> firstTriangles;  // one an instance, in the array of triangles
  // For shared/lookup_tables.glsl, and numbers that go with them.
  gpu::Buffer meshRows, idChunks, triangleFacts;  // the first a texel buffer; of one row where the scene has too many
  TriangleIds ids;
  float endMargin = 0.0f;  // metres
  bool masked = false;     // some material has holes
  bool instanced = false;  // some matrix is not the identity, or some mesh has two instances
  bool textured = false;   // some material has a texture
};

// Of an instance's triangle, by its place in the array of all triangles.
inline uint32_t triangleId(const SceneBuffers& scene, uint32_t instance, uint32_t triangle) {
  return scene.ids.firstIds[instance] + (triangle - scene.firstTriangles[instance]);
}

// A box around a box, placed.
Bounds placedBounds(const glm::mat4& worldFromMesh, const Bounds& bounds);

SceneBuffers createSceneBuffers(const gpu::Device& device, const Scene& scene);

// Records the draws for which `wanted` holds; the program is already bound.
template <typename Predicate>
void recordDraws(gpu::Commands& commands, const SceneBuffers& scene, Predicate wanted) {
  for (const Draw& draw : scene.draws)
    if (wanted(draw)) commands.drawIndexed(draw.indexCount, 1, draw.firstIndex, 0, draw.instance);
}

}  // namespace gnomon
