// A borrowed device: what is made on it is made without a submission, whatever the layout of the renderer's vertices
// and whosever the memory; and what cannot be done is said.
#include "shadow/embedded_shadow.h"
#include "base/error.h"
#include "gpu/pending_work.h"
#include "omni/cube_map.h"
#include "tests/gpu_fixture.h"

#include "shared/linked_mesh.glsl"

#include <glm/gtc/packing.hpp>

namespace gnomon {
namespace {

// Memory of one allocation each that the CPU never sees where it need not, so that uploads go through staging.
class HiddenMemory final : public gpu::MemorySource {
 public:
  explicit HiddenMemory(const gpu::Device& device) : device_(device) {}
  gpu::MemoryBlock allocate(const gpu::MemoryRequest& request) override {
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = request.needs.size + 256;
    info.memoryTypeIndex = device_.memoryType(request.needs.memoryTypeBits, request.required, request.preferred);
    gpu::MemoryBlock block{.offset = 256 / request.needs.alignment * request.needs.alignment};
    GNOMON_VK_CHECK(vkAllocateMemory(device_.handle(), &info, nullptr, &block.memory));
    if ((request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0) {
      void* mapped = nullptr;
      GNOMON_VK_CHECK(vkMapMemory(device_.handle(), block.memory, 0, VK_WHOLE_SIZE, 0, &mapped));
      block.mapped = static_cast<std::byte*>(mapped) + block.offset;
    }
    ++held;
    return block;
  }
  void release(const gpu::MemoryBlock& block) noexcept override {
    vkFreeMemory(device_.handle(), block.memory, nullptr);
    --held;
  }
  int held = 0;

 private:
  const gpu::Device& device_;
};

class EmbeddedShadowTest : public gpu::GpuTest {
 protected:
  EmbeddedShadowTest()
      : memory_(device()),
        lent_(gpu::Device::borrow({.physical = device().physical(),
                                   .device = device().handle(),
                                   .queueFamily = device().queueFamily(),
                                   .orderedAttachmentAccess = device().info().orderedAttachmentAccess,
                                   .memory = &memory_})) {}
  ~EmbeddedShadowTest() override {
    lent_.reset();
    EXPECT_EQ(memory_.held, 0);
  }

  const gpu::Device& lent() const { return *lent_; }

  template <typename T>
  gpu::Buffer hosts(const std::vector<T>& values) const {
    return gpu::createBufferWith(
        device(), "the renderer's", values,
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  }

  // Two triangles that stand before the light, in each of the formats.
  const std::vector<glm::vec3> positions_ = {{-1, -1, -2}, {1, -1, -2}, {1, 1, -2}, {-1, 1, -2}};
  const std::vector<uint32_t> triangles_ = {0, 1, 2, 0, 2, 3};

  HiddenMemory memory_;
  std::unique_ptr<gpu::Device> lent_;
};

TEST_F(EmbeddedShadowTest, TablesHoldTheMeshesOfEveryLayout) {
  struct Padded {  // 8 bytes before each position, 4 behind it
    float before[2];
    glm::vec3 position;
    float behind;
  };
  std::vector<Padded> padded;
  std::vector<uint64_t> halves{0}, shorts;
  for (const glm::vec3& p : positions_) {
    padded.push_back({{7.0f, 7.0f}, p, 7.0f});
    halves.push_back(glm::packHalf4x16(glm::vec4(p, 1.0f)));
    shorts.push_back(glm::packSnorm4x16(glm::vec4(p / 2.0f, 1.0f)));
  }
  std::vector<uint16_t> shortTriangles = {9};  // one index before the first
  for (const uint32_t i : triangles_) shortTriangles.push_back(static_cast<uint16_t>(i));
  shortTriangles.push_back(9);
  const gpu::Buffer paddedVertices = hosts(padded), halfVertices = hosts(halves), shortVertices = hosts(shorts);
  const gpu::Buffer indices = hosts(triangles_), shortIndices = hosts(shortTriangles);
  const Bounds bounds{glm::vec3(-2.0f), glm::vec3(2.0f)};
  const LentMesh meshes[] = {{.vertices = paddedVertices.handle(),
                              .vertexOffset = 8,
                              .vertexStride = sizeof(Padded),
                              .vertexCount = 4,
                              .indices = shortIndices.handle(),
                              .indexOffset = 2,
                              .indexType = VK_INDEX_TYPE_UINT16,
                              .indexCount = 6,
                              .bounds = bounds,
                              .positions = positions_,
                              .triangles = triangles_},
                             {.vertices = halfVertices.handle(),
                              .vertexOffset = 8,
                              .positionFormat = VK_FORMAT_R16G16B16A16_SFLOAT,
                              .vertexStride = 8,
                              .vertexCount = 4,
                              .indices = indices.handle(),
                              .indexCount = 6,
                              .bounds = bounds,
                              .positions = positions_,
                              .triangles = triangles_},
                             {.vertices = shortVertices.handle(),
                              .positionFormat = VK_FORMAT_R16G16B16A16_SNORM,
                              .vertexStride = 8,
                              .vertexCount = 4,
                              .indices = indices.handle(),
                              .indexCount = 6,
                              .bounds = bounds,
                              .positions = positions_,
                              .triangles = triangles_}};
  const LentInstance instances[] = {{.mesh = 0}, {.mesh = 1}, {.mesh = 2}};
  const LentGeometry geometry(
      lent(), {.meshes = meshes, .instances = instances, .tables = LentTables::Surfaces, .sceneBoundsW = bounds});
  gpu::Commands commands(device(), "tables");
  geometry.recordTables(commands.handle());
  commands.submitAndWait();
  lent().releaseStaging();
  const SceneBuffers& tables = geometry.buffers();
  const auto positions = gpu::downloadAs<glm::vec3>(device(), tables.positions);
  const auto triangles = gpu::downloadAs<uint32_t>(device(), tables.triangles);
  const auto rows = gpu::downloadAs<glsl::MeshRow>(device(), tables.meshRows);
  ASSERT_EQ(positions.size(), 12u);
  ASSERT_EQ(triangles.size(), 18u);
  ASSERT_EQ(rows.size(), 18u);
  for (uint32_t mesh = 0; mesh < 3; ++mesh) {
    const float scale = mesh == 2 ? 2.0f : 1.0f;
    for (uint32_t i = 0; i < 4; ++i)
      EXPECT_LE(glm::distance(positions[4 * mesh + i] * scale, positions_[i]), mesh == 2 ? 1e-4f : 0.0f) << mesh;
    for (uint32_t i = 0; i < 6; ++i) {
      EXPECT_EQ(triangles[6 * mesh + i], 4 * mesh + triangles_[i]);
      EXPECT_EQ(rows[6 * mesh + i].corner, positions[triangles[6 * mesh + i]]);
    }
    // The diagonal is the one edge with a neighbour.
    int links = 0;
    for (uint32_t i = 0; i < 6; ++i) links += rows[6 * mesh + i].link != glsl::kNoLink ? 1 : 0;
    EXPECT_EQ(links, 2);
  }
}

TEST_F(EmbeddedShadowTest, AMapFollowsTheLightAndTheMatrices) {
  const gpu::Buffer vertices = hosts(positions_), indices = hosts(triangles_);
  const Bounds bounds{glm::vec3(-1, -1, -2), glm::vec3(1, 1, -2)};
  const LentMesh mesh{
      .vertices = vertices.handle(), .vertexCount = 4, .indices = indices.handle(), .indexCount = 6, .bounds = bounds};
  const LentInstance instance;
  LentGeometry geometry(lent(), {.meshes = {&mesh, 1}, .instances = {&instance, 1}, .sceneBoundsW = bounds});
  const BiasMethod& bias = findBias("dual");
  const auto fitAt = [](double z) { return makeCubeMap({0, 0, z}, CubeDepth::Hyperbolic, 0.5, 10.0, 64, 4.0f); };
  EmbeddedShadow shadow(
      lent(), geometry,
      {.fit = fitAt(0.0), .bias = &bias, .params = defaultBiasParams(bias, 4.0f), .width = 8, .height = 8});
  // The middle of the face that looks along -z, in metres.
  const auto distance = [&](const FittedMap& fit) {
    const std::vector<float> depths = shadow.map().downloadDepth(device());
    const float depth = depths[(5 * 64 + 32) * 64 + 32];
    return glsl::mapDistance(fit.map, 5, {{0, 0, 0}, {0, 0, -1}}, depth);
  };
  const auto drawn = [&](const auto& record) {
    gpu::Commands commands(device(), "map");
    record(commands.handle());
    shadow.recordMap(commands.handle());
    commands.submitAndWait();
  };
  drawn([](VkCommandBuffer) {});
  EXPECT_NEAR(distance(fitAt(0.0)), 2.0f, 1e-4f);
  drawn([&](VkCommandBuffer commands) { shadow.recordLight(commands, fitAt(1.0), {.positionW = {0, 0, 1}}); });
  EXPECT_NEAR(distance(fitAt(1.0)), 3.0f, 1e-4f);
  glm::mat4 moved(1.0f);
  moved[3] = glm::vec4(0, 0, -2, 1);
  drawn([&](VkCommandBuffer commands) { geometry.recordInstances(commands, {&moved, 1}); });
  EXPECT_NEAR(distance(fitAt(1.0)), 5.0f, 1e-4f);
}

TEST_F(EmbeddedShadowTest, WhatIsMissingIsSaid) {
  const gpu::Buffer vertices = hosts(positions_), indices = hosts(triangles_);
  const Bounds bounds{glm::vec3(-1, -1, -2), glm::vec3(1, 1, -2)};
  LentMesh mesh{
      .vertices = vertices.handle(), .vertexCount = 4, .indices = indices.handle(), .indexCount = 6, .bounds = bounds};
  const LentInstance instance;
  const auto messageOf = [&](LentTables tables, const char* bias, ReceiverKind receivers) -> std::string {
    try {
      const LentGeometry geometry(
          lent(), {.meshes = {&mesh, 1}, .instances = {&instance, 1}, .tables = tables, .sceneBoundsW = bounds});
      const BiasMethod& method = findBias(bias);
      const EmbeddedShadow shadow(lent(), geometry,
                                  {.fit = makeCubeMap({}, CubeDepth::Hyperbolic, 0.5, 10.0, 64, 4.0f),
                                   .bias = &method,
                                   .params = defaultBiasParams(method, 4.0f),
                                   .width = 8,
                                   .height = 8,
                                   .receivers = receivers});
    } catch (const WorldError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(messageOf(LentTables::None, "adaptive", ReceiverKind::Depth), "");
  EXPECT_NE(messageOf(LentTables::None, "adaptive", ReceiverKind::Triangles).find("LentTables::Triangles"),
            std::string::npos);
  EXPECT_NE(messageOf(LentTables::Triangles, "witness", ReceiverKind::Depth).find("picture of triangles"),
            std::string::npos);
  EXPECT_NE(messageOf(LentTables::Triangles, "witness", ReceiverKind::Triangles).find("LentTables::Surfaces"),
            std::string::npos);
  EXPECT_NE(messageOf(LentTables::Surfaces, "witness", ReceiverKind::Triangles).find("on the CPU"), std::string::npos);
  mesh.vertexStride = 13;
  EXPECT_NE(messageOf(LentTables::None, "adaptive", ReceiverKind::Depth).find("13 bytes apart"), std::string::npos);
  mesh.vertexStride = 12;
  mesh.positionFormat = VK_FORMAT_R8G8B8A8_UNORM;
  EXPECT_NE(messageOf(LentTables::None, "adaptive", ReceiverKind::Depth).find("R32G32B32_SFLOAT"), std::string::npos);
}

}  // namespace
}  // namespace gnomon
