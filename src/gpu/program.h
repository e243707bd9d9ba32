#pragma once
// Programs: shaders and the interface reflected from their SPIR-V (bindings, push constants), so that wrong bindings
// fail a check at the call instead of giving a black picture.
//
// All bindings are in set 0 and are pushed (VK_KHR_push_descriptor). Every binding the SPIR-V declares must
// be given at each call: lavapipe 22.3 crashes on descriptors that were never written.

#include "gpu/resources.h"
#include "gpu/shader_compiler.h"
#include "gpu/specialize.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon::gpu {

struct ProgramInterface {
  struct Binding {
    uint32_t index = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    VkShaderStageFlags stages = 0;
    std::string name;
    bool repeats = false;  // a sampler2D
  };
  std::vector<Binding> bindings;  // by index, stages merged
  uint32_t pushConstantBytes = 0;
  VkShaderStageFlags pushConstantStages = 0;
};

// What a shader's SPIR-V uses of set 0 and as push constants.
ProgramInterface reflect(const std::vector<uint32_t>& spirv, VkShaderStageFlagBits stage);

class Program {
 public:
  VkPipeline pipeline() const { return pipeline_.get(); }
  VkPipelineLayout layout() const { return layout_.get(); }
  VkPipelineBindPoint bindPoint() const { return bindPoint_; }
  const ProgramInterface& interface() const { return interface_; }
  const std::string& name() const { return name_; }

 protected:
  void createLayouts(const Device& device);  // from interface_
  void adopt(const Device& device, VkPipeline pipeline);

  std::string name_;
  ProgramInterface interface_;
  VkPipelineBindPoint bindPoint_ = VK_PIPELINE_BIND_POINT_COMPUTE;
  OwnedChild<VkSampler, vkDestroySampler> sampler_;           // nearest, clamped: for every sampler of layers
  OwnedChild<VkSampler, vkDestroySampler> repeatingSampler_;  // linear, repeating: for every sampler2D
  OwnedChild<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> setLayout_;
  OwnedChild<VkPipelineLayout, vkDestroyPipelineLayout> layout_;
  OwnedChild<VkPipeline, vkDestroyPipeline> pipeline_;
};

class ComputeProgram : public Program {
 public:
  ComputeProgram() = default;
  ComputeProgram(const Device& device, const ShaderSource& shader,
                 const std::vector<Specialization>& specializations = {});
};

// Compute programs by shader and constants, each compiled when it is first asked for. References stay good.
class ComputePrograms {
 public:
  explicit ComputePrograms(const Device& device) : device_(device) {}
  const ComputeProgram& get(const std::string& path, const std::vector<Specialization>& specializations = {}) const {
    return get(ShaderSource{path, {}}, specializations);
  }
  const ComputeProgram& get(const ShaderSource& source, const std::vector<Specialization>& specializations) const;

 private:
  struct Entry {
    ShaderSource source;
    std::vector<Specialization> specializations;
    ComputeProgram program;
  };
  const Device& device_;
  mutable std::vector<std::unique_ptr<Entry>> entries_;
};

// One attribute of a vertex, in a buffer of its own, tightly packed; its location is its place in the list.
struct VertexStream {
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t stride = 0;  // bytes
  bool operator==(const VertexStream&) const = default;
};

struct GraphicsDesc {
  const char* name = nullptr;
  ShaderSource vertex;
  ShaderSource fragment;  // an empty path: depth only
  std::vector<Specialization> specializations;
  std::vector<VkFormat> colorFormats;  // of the attachments; VK_FORMAT_UNDEFINED where there is none
  VkFormat depthFormat = VK_FORMAT_UNDEFINED;
  VkCompareOp depthCompare = VK_COMPARE_OP_LESS;
  bool depthWrite = true;
  bool depthClamp = false;
  uint32_t viewMask = 0;  // multiview
  bool minBlend = false;  // colour attachments keep the minimum
  // Fragments read the colour attachments as input attachments, in the order of the triangles: for
  // RenderTargets::ordered. Needs DeviceInfo::orderedAttachmentAccess.
  bool ordered = false;
  std::vector<VertexStream> vertexStreams;  // none: the vertex shader pulls them from storage buffers
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
};

// Viewport, scissor, cull mode and front face are dynamic.
class GraphicsProgram : public Program {
 public:
  GraphicsProgram() = default;
  GraphicsProgram(const Device& device, const GraphicsDesc& desc);
};

}  // namespace gnomon::gpu
