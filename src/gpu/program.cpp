#include "gpu/program.h"

#include "base/check.h"
#include "base/error.h"
#include "gpu/ordered_pass.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon::gpu {

namespace {

using ShaderModule = OwnedChild<VkShaderModule, vkDestroyShaderModule>;

template <typename Handle>
void nameObject(const Device& device, VkObjectType type, Handle handle, const std::string& name) {
  device.nameObject(type, reinterpret_cast<uint64_t>(handle), name.c_str());
}

// Adds one stage's interface to the program's. The stages of a program must agree on what a binding is.
void merge(ProgramInterface& into, const ProgramInterface& stage, const std::string& name) {
  for (const ProgramInterface::Binding& binding : stage.bindings) {
    const auto same = std::find_if(into.bindings.begin(), into.bindings.end(),
                                   [&](const auto& other) { return other.index == binding.index; });
    if (same == into.bindings.end()) {
      into.bindings.push_back(binding);
      continue;
    }
    if (same->type != binding.type)
      throw WorldError(fmt::format(
          "{}: binding {} is both '{}' and '{}', which have different types; give one of them another number", name,
          binding.index, same->name, binding.name));
    same->stages |= binding.stages;
  }
  std::sort(into.bindings.begin(), into.bindings.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
  into.pushConstantBytes = std::max(into.pushConstantBytes, stage.pushConstantBytes);
  into.pushConstantStages |= stage.pushConstantStages;
}

// Shaders of one program, compiled and reflected.
struct Stages {
  std::vector<ShaderModule> modules;
  std::vector<VkPipelineShaderStageCreateInfo> infos;
  ProgramInterface interface;

  void add(const Device& device, const ShaderSource& source, VkShaderStageFlagBits stage,
           const std::vector<Specialization>& specializations, const std::string& programName) {
    const std::vector<uint32_t> compiled = compileShader(source);
    try {
      merge(interface, reflect(compiled, stage), programName);  // every variant of a shader binds alike
    } catch (const WorldError& error) {
      throw WorldError(fmt::format("{}: {}", source.path, error.what()));
    }
    const std::vector<uint32_t> spirv = specialize(compiled, specializations);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = spirv.size() * sizeof(uint32_t);
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    GNOMON_VK_CHECK(vkCreateShaderModule(device.handle(), &info, nullptr, &module));
    modules.emplace_back(device.handle(), module);
    nameObject(device, VK_OBJECT_TYPE_SHADER_MODULE, module, source.path);
    VkPipelineShaderStageCreateInfo stageInfo{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    stageInfo.stage = stage;
    stageInfo.module = module;
    stageInfo.pName = "main";
    infos.push_back(stageInfo);
  }
};

OwnedChild<VkSampler, vkDestroySampler> createSampler(const Device& device, VkFilter filter,
                                                      VkSamplerAddressMode beyond) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = filter;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = info.addressModeV = info.addressModeW = beyond;
  VkSampler sampler = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateSampler(device.handle(), &info, nullptr, &sampler));
  return {device.handle(), sampler};
}

OwnedChild<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> createSetLayout(const Device& device,
                                                                                const ProgramInterface& interface,
                                                                                VkSampler sampler,
                                                                                VkSampler repeating) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const ProgramInterface::Binding& binding : interface.bindings) {
    const bool sampled = binding.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const VkSampler* immutable = !sampled ? nullptr : binding.repeats ? &repeating : &sampler;
    bindings.push_back({binding.index, binding.type, 1, binding.stages, immutable});
  }
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  info.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  info.bindingCount = static_cast<uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &layout));
  return {device.handle(), layout};
}

OwnedChild<VkPipelineLayout, vkDestroyPipelineLayout> createLayout(const Device& device,
                                                                   const ProgramInterface& interface,
                                                                   VkDescriptorSetLayout setLayout) {
  const VkPushConstantRange push{interface.pushConstantStages, 0, interface.pushConstantBytes};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = 1;
  info.pSetLayouts = &setLayout;
  info.pushConstantRangeCount = push.size > 0 ? 1 : 0;
  info.pPushConstantRanges = &push;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout));
  return {device.handle(), layout};
}

// Everything of the graphics state that is not the same for all programs.
VkPipeline createGraphicsPipeline(const Device& device, const GraphicsDesc& desc,
                                  const std::vector<VkPipelineShaderStageCreateInfo>& stages, VkPipelineLayout layout) {
  std::vector<VkVertexInputBindingDescription> streams;
  std::vector<VkVertexInputAttributeDescription> attributes;
  for (const VertexStream& stream : desc.vertexStreams) {
    const auto number = static_cast<uint32_t>(streams.size());
    streams.push_back({number, stream.stride, VK_VERTEX_INPUT_RATE_VERTEX});
    attributes.push_back({number, number, stream.format, 0});
  }
  VkPipelineVertexInputStateCreateInfo vertexInput{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  vertexInput.vertexBindingDescriptionCount = static_cast<uint32_t>(streams.size());
  vertexInput.pVertexBindingDescriptions = streams.data();
  vertexInput.vertexAttributeDescriptionCount = static_cast<uint32_t>(attributes.size());
  vertexInput.pVertexAttributeDescriptions = attributes.data();
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = desc.topology;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = 1;
  viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.depthClampEnable = desc.depthClamp;
  raster.polygonMode = VK_POLYGON_MODE_FILL;
  raster.lineWidth = 1.0f;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const bool hasDepth = desc.depthFormat != VK_FORMAT_UNDEFINED;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = hasDepth;
  depth.depthWriteEnable = hasDepth && desc.depthWrite;
  depth.depthCompareOp = desc.depthCompare;
  VkPipelineColorBlendAttachmentState target{};
  target.colorWriteMask =
      VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  target.blendEnable = desc.minBlend;
  target.srcColorBlendFactor = target.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;  // MIN ignores the factors
  target.srcAlphaBlendFactor = target.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  target.colorBlendOp = target.alphaBlendOp = VK_BLEND_OP_MIN;
  std::vector<VkPipelineColorBlendAttachmentState> targets(desc.colorFormats.size(), target);
  for (size_t i = 0; i < targets.size(); ++i)
    if (desc.colorFormats[i] == VK_FORMAT_UNDEFINED) targets[i] = {};  // nothing is written where there is none
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = static_cast<uint32_t>(targets.size());
  blend.pAttachments = targets.data();
  if (desc.ordered) blend.flags = VK_PIPELINE_COLOR_BLEND_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_BIT_EXT;
  const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                          VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = static_cast<uint32_t>(std::size(dynamicStates));
  dynamic.pDynamicStates = dynamicStates;
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.viewMask = desc.viewMask;
  rendering.colorAttachmentCount = static_cast<uint32_t>(desc.colorFormats.size());
  rendering.pColorAttachmentFormats = desc.colorFormats.data();
  rendering.depthAttachmentFormat = desc.depthFormat;

  const auto pass =
      desc.ordered ? createOrderedPass(device, {.colors = desc.colorFormats, .depth = desc.depthFormat, .clear = true})
                   : OwnedChild<VkRenderPass, vkDestroyRenderPass>();

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                    desc.ordered ? nullptr : &rendering};
  info.renderPass = pass.get();
  info.stageCount = static_cast<uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &vertexInput;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateGraphicsPipelines(device.handle(), device.pipelineCache(), 1, &info, nullptr, &pipeline));
  return pipeline;
}

}  // namespace

void Program::createLayouts(const Device& device) {
  if (interface_.pushConstantBytes > device.info().maxPushConstantBytes)
    throw WorldError(fmt::format("{}: {} bytes of push constants, and device '{}' has {}; move some to a buffer", name_,
                                 interface_.pushConstantBytes, device.info().name, device.info().maxPushConstantBytes));
  for (const ProgramInterface::Binding& binding : interface_.bindings) {
    if (binding.type != VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) continue;
    if (binding.repeats)
      repeatingSampler_ = createSampler(device, VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT);
    else
      sampler_ = createSampler(device, VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  }
  setLayout_ = createSetLayout(device, interface_, sampler_.get(), repeatingSampler_.get());
  nameObject(device, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, setLayout_.get(), name_);
  layout_ = createLayout(device, interface_, setLayout_.get());
  nameObject(device, VK_OBJECT_TYPE_PIPELINE_LAYOUT, layout_.get(), name_);
}

void Program::adopt(const Device& device, VkPipeline pipeline) {
  pipeline_ = {device.handle(), pipeline};
  nameObject(device, VK_OBJECT_TYPE_PIPELINE, pipeline, name_);
}

ComputeProgram::ComputeProgram(const Device& device, const ShaderSource& shader,
                               const std::vector<Specialization>& specializations) {
  name_ = shader.path;
  bindPoint_ = VK_PIPELINE_BIND_POINT_COMPUTE;
  Stages stages;
  stages.add(device, shader, VK_SHADER_STAGE_COMPUTE_BIT, specializations, name_);
  interface_ = std::move(stages.interface);
  createLayouts(device);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = stages.infos[0];
  info.layout = layout();
  VkPipeline pipeline = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateComputePipelines(device.handle(), device.pipelineCache(), 1, &info, nullptr, &pipeline));
  adopt(device, pipeline);
}

const ComputeProgram& ComputePrograms::get(const ShaderSource& source,
                                           const std::vector<Specialization>& specializations) const {
  for (const auto& entry : entries_)
    if (entry->source == source && entry->specializations == specializations) return entry->program;
  entries_.push_back(
      std::make_unique<Entry>(Entry{source, specializations, ComputeProgram(device_, source, specializations)}));
  return entries_.back()->program;
}

GraphicsProgram::GraphicsProgram(const Device& device, const GraphicsDesc& desc) {
  GNOMON_CHECK(desc.name != nullptr);
  name_ = desc.name;
  bindPoint_ = VK_PIPELINE_BIND_POINT_GRAPHICS;
  Stages stages;
  stages.add(device, desc.vertex, VK_SHADER_STAGE_VERTEX_BIT, desc.specializations, name_);
  if (!desc.fragment.path.empty())
    stages.add(device, desc.fragment, VK_SHADER_STAGE_FRAGMENT_BIT, desc.specializations, name_);
  interface_ = std::move(stages.interface);
  createLayouts(device);
  adopt(device, createGraphicsPipeline(device, desc, stages.infos, layout()));
}

}  // namespace gnomon::gpu
