#include "scene/lent_geometry.h"

#include "base/check.h"
#include "base/error.h"
#include "scene/mesh_links.h"

#include "shared/gather_mesh.glsl"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

int gatherFormat(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R32G32B32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return glsl::kGatherFloat;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return glsl::kGatherHalf;
    case VK_FORMAT_R16G16B16A16_SNORM:
      return glsl::kGatherSnorm;
    default:
      throw WorldError(fmt::format(
          "positions of VkFormat {}: give them as R32G32B32_SFLOAT, R32G32B32A32_SFLOAT, R16G16B16A16_SFLOAT or "
          "R16G16B16A16_SNORM",
          static_cast<int>(format)));
  }
}

void check(const LentMesh& mesh, size_t number, LentTables tables) {
  gatherFormat(mesh.positionFormat);
  if (mesh.indexType != VK_INDEX_TYPE_UINT16 && mesh.indexType != VK_INDEX_TYPE_UINT32)
    throw WorldError(fmt::format("mesh {}: its indices are not of 16 or 32 bits; convert them", number));
  if (mesh.indexCount % 3 != 0)
    throw WorldError(fmt::format("mesh {}: {} indices are no list of triangles", number, mesh.indexCount));
  if (mesh.vertexOffset % 4 != 0 || mesh.vertexStride % 4 != 0)
    throw WorldError(
        fmt::format("mesh {}: its positions begin at byte {} and are {} bytes apart; both must be multiples "
                    "of 4",
                    number, mesh.vertexOffset, mesh.vertexStride));
  if (tables == LentTables::Surfaces &&
      (mesh.triangles.size() != mesh.indexCount || mesh.positions.size() != mesh.vertexCount))
    throw WorldError(fmt::format(
        "mesh {}: biases that follow surfaces need its {} positions and {} indices on the CPU, too, and were "
        "given {} and {}",
        number, mesh.vertexCount, mesh.indexCount, mesh.positions.size(), mesh.triangles.size()));
}

VertexSource sourceOf(const LentMesh& mesh, uint32_t firstTriangle) {
  return {.vertices = gpu::Buffer(mesh.vertices, 0),
          .indices = gpu::Buffer(mesh.indices, 0),
          .vertexOffset = mesh.vertexOffset,
          .indexOffset = mesh.indexOffset,
          .format = mesh.positionFormat,
          .stride = mesh.vertexStride,
          .indexType = mesh.indexType,
          .firstIndex = 3 * firstTriangle};
}

// As SceneBuffers' tables need it: meshes in their order, and who stands where.
Scene onTheCpu(const LentGeometryDesc& desc) {
  Scene scene;
  scene.materials.emplace_back();
  for (const LentMesh& mesh : desc.meshes) {
    scene.meshes.emplace_back();
    scene.meshes.back().positions.assign(mesh.positions.begin(), mesh.positions.end());
    scene.meshes.back().indices.assign(mesh.triangles.begin(), mesh.triangles.end());
  }
  for (const LentInstance& instance : desc.instances)
    scene.instances.push_back({.name = "",
                               .path = "",
                               .mesh = static_cast<int>(instance.mesh),
                               .casts = instance.casts,
                               .worldFromMesh = instance.worldFromMesh});
  return scene;
}

}  // namespace

LentGeometry::LentGeometry(const gpu::Device& device, const LentGeometryDesc& desc)
    : device_(device), meshes_(desc.meshes.begin(), desc.meshes.end()), tables_(desc.tables) {
  uint32_t vertices = 0, triangles = 0;
  for (size_t i = 0; i < meshes_.size(); ++i) {
    check(meshes_[i], i, tables_);
    places_.push_back({vertices, triangles});
    sources_.push_back(sourceOf(meshes_[i], triangles));
    vertices += meshes_[i].vertexCount;
    triangles += meshes_[i].indexCount / 3;
  }
  std::vector<uint32_t> triangleCounts;
  std::vector<bool> used(meshes_.size(), false);
  buffers_.instanced = desc.moves;
  for (const LentInstance& instance : desc.instances) {
    GNOMON_CHECK_LT(instance.mesh, meshes_.size());
    const LentMesh& mesh = meshes_[instance.mesh];
    const Place& place = places_[instance.mesh];
    buffers_.draws.push_back({.indexCount = mesh.indexCount,
                              .firstIndex = 3 * place.firstTriangle,
                              .instance = static_cast<uint32_t>(meshOf_.size()),
                              .doubleSided = !mesh.solid,
                              .solid = mesh.solid,
                              .casts = instance.casts,
                              .mirrored = glm::determinant(glm::mat3(instance.worldFromMesh)) < 0.0f,
                              .worldFromMesh = instance.worldFromMesh,
                              .boundsW = placedBounds(instance.worldFromMesh, mesh.bounds),
                              .source = &sources_[instance.mesh]});
    meshOf_.push_back(instance.mesh);
    triangleCounts.push_back(mesh.indexCount / 3);
    buffers_.firstTriangles.push_back(place.firstTriangle);
    buffers_.instanced = buffers_.instanced || used[instance.mesh] || instance.worldFromMesh != glm::mat4(1.0f);
    used[instance.mesh] = true;
    instances_.push_back({.worldFromMesh = instance.worldFromMesh, .firstTriangle = place.firstTriangle});
  }
  buffers_.endMargin = receiverMargin(desc.sceneBoundsW);
  buffers_.ids = numberTriangles(triangleCounts, buffers_.firstTriangles, buffers_.instanced);
  for (size_t i = 0; i < instances_.size(); ++i) instances_[i].firstId = buffers_.ids.firstIds[i];
  buffers_.instances = gpu::createBufferWith(device, "instances", instances_);
  buffers_.idChunks = gpu::createBufferWith(device, "id chunks", buffers_.ids.chunks);
  buffers_.materials = gpu::createBufferWith(device, "materials", std::vector<glsl::SceneMaterial>{{}});
  // Bound and not read: lent meshes have no holes.
  buffers_.uvs = gpu::Buffer(device, {.name = "no uvs"});
  buffers_.textures = gpu::Buffer(device, {.name = "no textures"});
  buffers_.texels = gpu::Buffer(device, {.name = "no texels"});
  buffers_.normals = gpu::Buffer(device, {.name = "no normals"});

  const bool kept = tables_ != LentTables::None;
  buffers_.positions = gpu::Buffer(device, {.name = "positions", .size = kept ? vertices * sizeof(glm::vec3) : 0});
  buffers_.triangles = gpu::Buffer(device, {.name = "triangles", .size = kept ? triangles * sizeof(glm::uvec3) : 0});
  MeshLinks links;
  if (tables_ == LentTables::Surfaces) {
    links = linkMeshes(onTheCpu(desc), buffers_.instanced);
    if (links.rows.size() > device.info().maxTexelBufferElements)
      throw WorldError(
          fmt::format("the device's texel buffers hold {} rows, and the meshes have {}, three a triangle; "
                      "choose a bias that does not follow surfaces",
                      device.info().maxTexelBufferElements, links.rows.size()));
  }
  buffers_.triangleFacts = gpu::createBufferWith(device, "triangle facts", links.facts);
  buffers_.meshRows =
      gpu::Buffer(device, {.name = "mesh rows",
                           .size = std::max<size_t>(links.rows.size(), 1) * sizeof(glsl::MeshRow),
                           .usage = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                           .texels = VK_FORMAT_R32G32B32A32_UINT});
  if (!links.rows.empty()) gpu::upload(device, buffers_.meshRows, std::as_bytes(std::span(links.rows)));
  if (kept) gather_ = gpu::ComputeProgram(device, {"scene/gather_mesh.comp.glsl", {}});
}

void LentGeometry::recordTables(VkCommandBuffer lent, uint32_t first, uint32_t count) const {
  gpu::Commands commands(device_, lent,
                         "the renderer writes vertices, earlier frames read the tables -> they are copied");
  GNOMON_CHECK(tables_ != LentTables::None);
  const size_t end = std::min<size_t>(meshes_.size(), size_t{first} + count);
  for (size_t i = first; i < end; ++i) {
    const LentMesh& mesh = meshes_[i];
    const glsl::GatherPush push{.vertexWord = static_cast<uint32_t>(mesh.vertexOffset / 4),
                                .strideWords = mesh.vertexStride / 4,
                                .format = gatherFormat(mesh.positionFormat),
                                .vertexCount = mesh.vertexCount,
                                .firstVertex = places_[i].firstVertex,
                                .indexByte = static_cast<uint32_t>(mesh.indexOffset),
                                .shortIndices = mesh.indexType == VK_INDEX_TYPE_UINT16 ? 1 : 0,
                                .triangleCount = mesh.indexCount / 3,
                                .firstTriangle = places_[i].firstTriangle,
                                .hasRows = tables_ == LentTables::Surfaces ? 1 : 0};
    const uint32_t groups =
        (std::max(push.vertexCount, push.triangleCount) + glsl::kGatherGroupSize - 1) / glsl::kGatherGroupSize;
    if (groups == 0) continue;
    const uint32_t rows = (groups + glsl::kMostGatherGroupsX - 1) / glsl::kMostGatherGroupsX;
    commands.dispatch(gather_, {std::min(groups, glsl::kMostGatherGroupsX), rows, 1}, gpu::asPush(push),
                      {{glsl::kBindLentVertices, sources_[i].vertices},
                       {glsl::kBindLentIndices, sources_[i].indices},
                       {glsl::kBindPositions, buffers_.positions},
                       {glsl::kBindTriangles, buffers_.triangles},
                       {glsl::kBindGatheredRows, buffers_.meshRows}});
  }
  commands.barrier("the tables hold the meshes -> maps, volumes and look-ups read them");
}

void LentGeometry::recordInstances(VkCommandBuffer lent, std::span<const glm::mat4> worldFromMesh) {
  gpu::Commands commands(device_, lent, "earlier frames read matrices -> they are written");
  GNOMON_CHECK_EQ(worldFromMesh.size(), instances_.size());
  GNOMON_CHECK(buffers_.instanced);
  for (size_t i = 0; i < instances_.size(); ++i) {
    instances_[i].worldFromMesh = worldFromMesh[i];
    Draw& draw = buffers_.draws[i];
    draw.worldFromMesh = worldFromMesh[i];
    draw.mirrored = glm::determinant(glm::mat3(worldFromMesh[i])) < 0.0f;
    draw.boundsW = placedBounds(worldFromMesh[i], meshes_[meshOf_[i]].bounds);
  }
  commands.update(buffers_.instances, std::as_bytes(std::span(instances_)));
  commands.barrier("matrices are written -> maps, volumes and look-ups read them");
}

}  // namespace gnomon
