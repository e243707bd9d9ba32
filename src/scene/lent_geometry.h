#pragma once
// A renderer's own meshes as casters and receivers: its vertex and index buffers, described, and where their instances
// stand. No Scene on the CPU.
//
// Maps of straight edges (cube, spot) are drawn from those buffers as they are. What asks for single triangles (the
// paraboloid's exact rasterizer, a shadow volume's, receivers named by their triangle, biases that follow surfaces)
// reads tables, which recordTables() copies on the device.

#include "scene/scene_buffers.h"

#include <span>
#include <vector>

namespace gnomon {

struct LentMesh {
  // Usage VERTEX_BUFFER, and with tables STORAGE_BUFFER.
  VkBuffer vertices = VK_NULL_HANDLE;
  VkDeviceSize vertexOffset = 0;                         // bytes to the first vertex's position; a multiple of 4
  VkFormat positionFormat = VK_FORMAT_R32G32B32_SFLOAT;  // or R32G32B32A32_SFLOAT, R16G16B16A16_SFLOAT, _SNORM
  uint32_t vertexStride = 12;                            // bytes from one position to the next; a multiple of 4
  uint32_t vertexCount = 0;
  // Usage INDEX_BUFFER, and with tables STORAGE_BUFFER. A triangle list, counter-clockwise seen from the front.
  VkBuffer indices = VK_NULL_HANDLE;
  VkDeviceSize indexOffset = 0;                  // bytes to the first index
  VkIndexType indexType = VK_INDEX_TYPE_UINT32;  // or UINT16
  uint32_t indexCount = 0;
  Bounds bounds;       // of the positions, in the mesh's space
  bool solid = false;  // closed and one-sided: maps may leave out the faces that look away from the light
  // The same mesh on the CPU, read once: which triangles are neighbours. For LentTables::Surfaces.
  std::span<const glm::vec3> positions = {};
  std::span<const uint32_t> triangles = {};  // three a triangle
};

struct LentInstance {
  uint32_t mesh = 0;
  glm::mat4 worldFromMesh{1.0f};
  bool casts = true;  // a shadow; else it is only seen
};

// What is kept beside the renderer's buffers.
enum class LentTables {
  None,       // nothing: cube and spot maps, receivers from a depth buffer
  Triangles,  // 12 bytes a vertex and 12 a triangle: paraboloids, volumes, receivers from a picture of triangles
  Surfaces,   // and 56 a triangle: two-plane, witness
};

struct LentGeometryDesc {
  std::span<const LentMesh> meshes;
  std::span<const LentInstance> instances;
  LentTables tables = LentTables::None;
  Bounds sceneBoundsW;  // of all that may cast or receive, metres
  // Matrices may change later (recordInstances); else where all of them are the identity, none is read.
  bool moves = true;
};

class LentGeometry {
 public:
  // Throws WorldError where the tables do not fit, or a format or an alignment is none of the above.
  LentGeometry(const gpu::Device& device, const LentGeometryDesc& desc);
  LentGeometry(const LentGeometry&) = delete;
  LentGeometry& operator=(const LentGeometry&) = delete;

  // Copies meshes [first, first + count) into the tables: once, and again where their vertices have changed. Their
  // bounds are as described.
  // The renderer writes vertices and indices -> tables are copied from them -> maps, volumes and look-ups read them.
  void recordTables(VkCommandBuffer commands, uint32_t first = 0, uint32_t count = ~0u) const;
  // New matrices for all instances, for the commands that follow.
  void recordInstances(VkCommandBuffer commands, std::span<const glm::mat4> worldFromMesh);

  const SceneBuffers& buffers() const { return buffers_; }
  LentTables tables() const { return tables_; }

 private:
  const gpu::Device& device_;
  struct Place {
    uint32_t firstVertex = 0, firstTriangle = 0;
  };

  std::vector<LentMesh> meshes_;
  std::vector<Place> places_;
  std::vector<VertexSource> sources_;
  std::vector<uint32_t> meshOf_;  // of each instance
  std::vector<glsl::SceneInstance> instances_;
  LentTables tables_;
  SceneBuffers buffers_;
  gpu::ComputeProgram gather_;
};

}  // namespace gnomon
