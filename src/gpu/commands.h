#pragma once
// One command buffer, recorded, submitted and waited for. A pass is one call with its program and everything that is
// bound; between two passes there is one barrier, with a text that says who wrote and who reads.

#include "gpu/ordered_pass.h"
#include "gpu/program.h"

#include <glm/glm.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gnomon::gpu {

// A resource for one binding of a program: a storage buffer, a storage image, a sampled image (texelFetch), or one
// layer of an image as an input attachment.
struct Binding {
  uint32_t index;
  const Buffer* buffer = nullptr;
  const Image* image = nullptr;
  std::optional<uint32_t> layer;
  Binding(uint32_t i, const Buffer& b) : index(i), buffer(&b) {}
  Binding(uint32_t i, const Image& im, std::optional<uint32_t> l = {}) : index(i), image(&im), layer(l) {}
};

// Those that a program declares.
std::vector<Binding> declaredBy(const Program& program, std::vector<Binding> bindings);

struct ColorTarget {
  const Image* image = nullptr;            // none: what fragments write here goes nowhere
  std::optional<VkClearColorValue> clear;  // absent: keep what is there
};

struct RenderTargets {
  std::vector<ColorTarget> colors;
  const Image* depth = nullptr;
  std::optional<float> clearDepth;  // absent: keep what is there
  std::optional<uint32_t> layer;    // draw to this layer only; absent: the whole view (layer 0, or multiview)
  // Wrong on lavapipe 22.3.6, whose rasterizer learns of a new view only now and then: triangles that the
  // view volume clips all land in layer 0, and views from the third on are lost. One pass a layer is right on
  // every device, and faster on lavapipe.
  uint32_t viewMask = 0;
  // Fragments read the colours that were there before them (GraphicsDesc::ordered). One layer, all targets cleared or
  // all kept.
  bool ordered = false;
  OrderedTargets* kept = nullptr;  // where what that takes is kept from one time to the next; none: as long as Commands
};

// What RenderTargets::ordered takes, made in `kept` if it is not there yet: a pass and a framebuffer.
OrderedTargets::Made makeOrdered(const Device& device, const RenderTargets& targets, OrderedTargets& kept);

struct StageTime {
  std::string name;
  double gpuMs = 0.0;  // between two timestamps
};

struct Submission {
  double wallMs = 0.0;  // submit to the end of the wait
  std::vector<StageTime> stages;
};

class Commands {
 public:
  Commands(const Device& device, const char* name);
  // Records into somebody else's command buffer, which is being recorded outside of a render pass. Nothing is made,
  // submitted or waited for, and stages are labels without times. Whatever the device has pending comes first.
  // `words`: what was written before and is read here.
  Commands(const Device& device, VkCommandBuffer lent, const char* words);
  ~Commands();
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  // A named stretch with timestamps around it; stages do not nest.
  void beginStage(const char* name);
  void endStage();

  // Everything before is visible to everything after. `words`: "shadow map writes depth -> visibility fetches it".
  void barrier(const char* words);

  // Checks that `push` has the size the program declares and that exactly its bindings are given.
  void dispatch(const ComputeProgram& program, glm::uvec3 groupCount, std::span<const std::byte> push,
                const std::vector<Binding>& bindings);

  // `arguments`: a VkDispatchIndirectCommand at `offset`; its usage has VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT.
  void dispatchIndirect(const ComputeProgram& program, const Buffer& arguments, VkDeviceSize offset,
                        std::span<const std::byte> push, const std::vector<Binding>& bindings);

  // Viewport and scissor cover the targets; culling is off until setCulling.
  void beginRendering(const RenderTargets& targets);
  void bind(const GraphicsProgram& program, std::span<const std::byte> push, const std::vector<Binding>& bindings);
  // Other push constants for the program that is bound.
  void push(const GraphicsProgram& program, std::span<const std::byte> push);
  void setCulling(VkCullModeFlags mode, VkFrontFace front);
  void bindIndexBuffer(const Buffer& buffer, VkDeviceSize offset = 0, VkIndexType type = VK_INDEX_TYPE_UINT32);
  void bindVertexStreams(const std::vector<const Buffer*>& streams);  // GraphicsDesc::vertexStreams
  void bindVertexStream(const Buffer& stream, VkDeviceSize offset);   // the only one
  void drawIndexed(uint32_t indexCount, uint32_t instanceCount, uint32_t firstIndex, int32_t vertexOffset,
                   uint32_t firstInstance);
  void draw(uint32_t vertexCount, uint32_t instanceCount, uint32_t firstVertex, uint32_t firstInstance);
  // `arguments`: one VkDrawIndirectCommand; its usage has VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT.
  void drawIndirect(const Buffer& arguments);
  void endRendering();

  void fill(const Buffer& buffer, uint32_t word);
  // As the commands are executed: earlier ones see what was there before. At most 64 KiB a piece, in as many pieces.
  void update(const Buffer& buffer, std::span<const std::byte> bytes, VkDeviceSize offset = 0);
  void copy(const Buffer& from, const Buffer& to, VkDeviceSize size);
  void copy(const Image& from, const Buffer& to);  // all layers and components, tightly packed
  void copy(const Buffer& from, const Image& to, VkDeviceSize fromOffset);

  VkCommandBuffer handle() const { return commands_; }

  // Once. Throws WorldError when the device is lost.
  Submission submitAndWait();

 private:
  void beginDynamic(const RenderTargets& targets, VkExtent2D extent);
  void beginOrdered(const RenderTargets& targets, VkExtent2D extent);
  std::vector<StageTime> readStages() const;

  const Device& device_;
  OwnedChild<VkCommandPool, vkDestroyCommandPool> pool_;
  OwnedChild<VkQueryPool, vkDestroyQueryPool> queries_;
  OwnedChild<VkFence, vkDestroyFence> fence_;
  OrderedTargets ordered_;  // until the device is done with them
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  bool lent_ = false;
  std::vector<std::string> stageNames_;
  bool inStage_ = false;
  bool inRendering_ = false;
  bool inOrderedPass_ = false;
  bool submitted_ = false;
};

template <typename T>
std::span<const std::byte> asPush(const T& value) {
  return std::as_bytes(std::span<const T, 1>(&value, 1));
}

}  // namespace gnomon::gpu
