#include "renderer.h"

#include <array>
#include <cmath>

#include "draw.frag.h"
#include "draw.vert.h"
#include "shade.comp.h"

namespace {

struct DrawPush {
  glm::mat4 clipFromWorld, worldFromMesh;
};
struct ShadePush {
  glm::mat4 worldFromEye;
  glm::vec4 light;
  glm::vec2 tanHalf;
  float zNear, fogPerMetre;
};

glm::mat4 eyeFromWorld(const glm::mat4& worldFromEye) {
  const glm::mat3 turn = glm::transpose(glm::mat3(worldFromEye));
  glm::mat4 m(turn);
  m[3] = glm::vec4(-(turn * glm::vec3(worldFromEye[3])), 1.0f);
  return m;
}

}  // namespace

Renderer::Renderer(Gpu& gpu, const Room& room) : gpu_(gpu), room_(room) {
  const float tanHalf = std::tan(0.5f * room.yFovRad);
  clipFromEye[0][0] = 1.0f / tanHalf;
  clipFromEye[1][1] = -1.0f / tanHalf;
  clipFromEye[2][3] = -1.0f;
  clipFromEye[3][2] = room.zNear;
  // Maps are drawn from these as vertices and indices; what looks at single triangles reads them as storage buffers.
  for (const RoomMesh& mesh : room.meshes)
    meshes.push_back(
        {makeBuffer(gpu, mesh.vertices.size() * sizeof(Vertex),
                    VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, mesh.vertices.data()),
         makeBuffer(gpu, (mesh.indices.size() * sizeof(uint16_t) + 3) / 4 * 4,
                    VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)});
  for (size_t i = 0; i < meshes.size(); ++i)
    std::memcpy(meshes[i].indices.mapped, room.meshes[i].indices.data(),
                room.meshes[i].indices.size() * sizeof(uint16_t));
  std::vector<glm::vec4> colors;
  for (const RoomInstance& instance : room.instances) colors.emplace_back(room.meshes[instance.mesh].color, 1.0f);
  colors_ = makeBuffer(gpu, colors.size() * sizeof(glm::vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, colors.data());

  const VkImageUsageFlags target = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  depth = makeImage(gpu, VK_FORMAT_D32_SFLOAT, kSide, kSide,
                    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  normals = makeImage(gpu, VK_FORMAT_R16G16B16A16_SNORM, kSide, kSide, target);
  triangles = makeImage(gpu, VK_FORMAT_R32G32_UINT, kSide, kSide, target);
  const VkImageUsageFlags stored = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  visibility = makeImage(gpu, kVisibilityFormat, kSide, kSide, stored);
  fog = makeImage(gpu, kFogFormat, kSide, kSide, stored | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  picture = makeImage(gpu, VK_FORMAT_R8G8B8A8_UNORM, kSide, kSide, stored);
  pictureBytes = makeBuffer(gpu, 4 * kSide * kSide, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  visibilityBytes = makeBuffer(gpu, kSide * kSide, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  fogBytes = makeBuffer(gpu, 8 * kSide * kSide, VK_BUFFER_USAGE_TRANSFER_DST_BIT);

  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = gpu.family;
  VK(vkCreateCommandPool(gpu.device, &pool, nullptr, &pool_));
  VkCommandBufferAllocateInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  buffer.commandPool = pool_;
  buffer.commandBufferCount = 1;
  VK(vkAllocateCommandBuffers(gpu.device, &buffer, &commands_));
  const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VK(vkCreateFence(gpu.device, &fence, nullptr, &fence_));
  VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
  queries.queryCount = 8;
  VK(vkCreateQueryPool(gpu.device, &queries, nullptr, &stamps_));
  makePipelines();
}

void Renderer::makePipelines() {
  const VkShaderModule vertex = makeShader(gpu_, draw_vert, sizeof(draw_vert));
  const VkShaderModule fragment = makeShader(gpu_, draw_frag, sizeof(draw_frag));
  const VkShaderModule compute = makeShader(gpu_, shade_comp, sizeof(shade_comp));
  const VkPushConstantRange drawPush{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(DrawPush)};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &drawPush;
  VK(vkCreatePipelineLayout(gpu_.device, &layout, nullptr, &drawLayout_));

  VkPipelineShaderStageCreateInfo stages[2] = {{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO},
                                               {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO}};
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT, stages[0].module = vertex, stages[0].pName = "main";
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT, stages[1].module = fragment, stages[1].pName = "main";
  const VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
  const VkVertexInputAttributeDescription attributes[] = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                                          {1, 0, VK_FORMAT_R32G32B32_SFLOAT, sizeof(glm::vec3)}};
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  input.vertexBindingDescriptionCount = 1, input.pVertexBindingDescriptions = &binding;
  input.vertexAttributeDescriptionCount = 2, input.pVertexAttributeDescriptions = attributes;
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  const VkViewport viewport{0, 0, kSide, kSide, 0, 1};
  const VkRect2D scissor{{0, 0}, {kSide, kSide}};
  VkPipelineViewportStateCreateInfo view{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  view.viewportCount = view.scissorCount = 1, view.pViewports = &viewport, view.pScissors = &scissor;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE, raster.lineWidth = 1.0f;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo test{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  test.depthTestEnable = test.depthWriteEnable = VK_TRUE, test.depthCompareOp = VK_COMPARE_OP_GREATER;
  VkPipelineColorBlendAttachmentState write{};
  write.colorWriteMask = 0xf;
  const VkPipelineColorBlendAttachmentState writes[] = {write, write};
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = 2, blend.pAttachments = writes;
  const VkDynamicState culling = VK_DYNAMIC_STATE_CULL_MODE;
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 1, dynamic.pDynamicStates = &culling;
  const VkFormat formats[] = {normals.format, triangles.format};
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = 2, rendering.pColorAttachmentFormats = formats;
  rendering.depthAttachmentFormat = depth.format;
  VkGraphicsPipelineCreateInfo draw{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  draw.stageCount = 2, draw.pStages = stages, draw.pVertexInputState = &input, draw.pInputAssemblyState = &assembly;
  draw.pViewportState = &view, draw.pRasterizationState = &raster, draw.pMultisampleState = &samples;
  draw.pDepthStencilState = &test, draw.pColorBlendState = &blend, draw.pDynamicState = &dynamic;
  draw.layout = drawLayout_;
  VK(vkCreateGraphicsPipelines(gpu_.device, VK_NULL_HANDLE, 1, &draw, nullptr, &draw_));
  // A slice of a map: depth alone, of any size, clamped so that what is nearer than the near end still casts a shadow.
  const VkDynamicState sized[] = {VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  dynamic.dynamicStateCount = 3, dynamic.pDynamicStates = sized;
  raster.depthClampEnable = VK_TRUE, test.depthCompareOp = VK_COMPARE_OP_LESS;
  rendering.colorAttachmentCount = 0, blend.attachmentCount = 0, draw.stageCount = 1;
  VK(vkCreateGraphicsPipelines(gpu_.device, VK_NULL_HANDLE, 1, &draw, nullptr, &map_));

  const VkDescriptorType types[7] = {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                     VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                     VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                     VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
  std::array<VkDescriptorSetLayoutBinding, 7> bindings{};
  for (uint32_t i = 0; i < 7; ++i) bindings[i] = {i, types[i], 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  setInfo.bindingCount = 7, setInfo.pBindings = bindings.data();
  VK(vkCreateDescriptorSetLayout(gpu_.device, &setInfo, nullptr, &setLayout_));
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 3},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 3},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
  VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  poolInfo.maxSets = 1, poolInfo.poolSizeCount = 3, poolInfo.pPoolSizes = sizes;
  VK(vkCreateDescriptorPool(gpu_.device, &poolInfo, nullptr, &setPool_));
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocate.descriptorPool = setPool_, allocate.descriptorSetCount = 1, allocate.pSetLayouts = &setLayout_;
  VK(vkAllocateDescriptorSets(gpu_.device, &allocate, &set_));
  const GpuImage* images[] = {&depth, &normals, &triangles, &visibility, &fog, &picture};
  const VkDescriptorBufferInfo colors{colors_.buffer, 0, VK_WHOLE_SIZE};
  for (uint32_t i = 0; i < 7; ++i) {
    VkDescriptorImageInfo image{};
    if (i < 6)
      image = {VK_NULL_HANDLE, images[i]->view,
               i < 3 ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet one{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    one.dstSet = set_, one.dstBinding = i, one.descriptorCount = 1, one.descriptorType = types[i];
    one.pImageInfo = &image, one.pBufferInfo = &colors;
    vkUpdateDescriptorSets(gpu_.device, 1, &one, 0, nullptr);
  }
  const VkPushConstantRange shadePush{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(ShadePush)};
  layout.pPushConstantRanges = &shadePush, layout.setLayoutCount = 1, layout.pSetLayouts = &setLayout_;
  VK(vkCreatePipelineLayout(gpu_.device, &layout, nullptr, &shadeLayout_));
  VkComputePipelineCreateInfo shade{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  shade.stage = stages[0], shade.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT, shade.stage.module = compute;
  shade.layout = shadeLayout_;
  VK(vkCreateComputePipelines(gpu_.device, VK_NULL_HANDLE, 1, &shade, nullptr, &shade_));
  for (const VkShaderModule module : {vertex, fragment, compute}) vkDestroyShaderModule(gpu_.device, module, nullptr);
}

Renderer::~Renderer() {
  vkDestroyPipeline(gpu_.device, draw_, nullptr);
  vkDestroyPipeline(gpu_.device, map_, nullptr);
  vkDestroyPipeline(gpu_.device, shade_, nullptr);
  vkDestroyPipelineLayout(gpu_.device, drawLayout_, nullptr);
  vkDestroyPipelineLayout(gpu_.device, shadeLayout_, nullptr);
  vkDestroyDescriptorPool(gpu_.device, setPool_, nullptr);
  vkDestroyDescriptorSetLayout(gpu_.device, setLayout_, nullptr);
  vkDestroyQueryPool(gpu_.device, stamps_, nullptr);
  vkDestroyFence(gpu_.device, fence_, nullptr);
  vkDestroyCommandPool(gpu_.device, pool_, nullptr);
  for (GpuImage* image : {&depth, &normals, &triangles, &visibility, &fog, &picture}) destroy(gpu_, *image);
  for (GpuBuffer* buffer : {&colors_, &pictureBytes, &visibilityBytes, &fogBytes}) destroy(gpu_, *buffer);
  for (MeshBuffers& mesh : meshes) destroy(gpu_, mesh.vertices), destroy(gpu_, mesh.indices);
}

VkCommandBuffer Renderer::begin() {
  const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  VK(vkBeginCommandBuffer(commands_, &info));
  vkCmdResetQueryPool(commands_, stamps_, 0, 8);
  return commands_;
}

void Renderer::drawRoom(VkCommandBuffer commands, const glm::mat4& clipFromWorld, bool culls) {
  for (uint32_t i = 0; i < room_.instances.size(); ++i) {
    const uint32_t mesh = room_.instances[i].mesh;
    const DrawPush push{clipFromWorld, room_.instances[i].worldFromMesh};
    const VkDeviceSize start = 0;
    vkCmdSetCullMode(commands, culls && room_.meshes[mesh].closed ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE);
    vkCmdPushConstants(commands, drawLayout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(push), &push);
    vkCmdBindVertexBuffers(commands, 0, 1, &meshes[mesh].vertices.buffer, &start);
    vkCmdBindIndexBuffer(commands, meshes[mesh].indices.buffer, 0, VK_INDEX_TYPE_UINT16);
    vkCmdDrawIndexed(commands, static_cast<uint32_t>(room_.meshes[mesh].indices.size()), 1, 0, 0, i);
  }
}

void Renderer::drawMap(VkCommandBuffer commands, const glm::mat4& clipFromWorld) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, map_);
  drawRoom(commands, clipFromWorld, false);
}

// The last frame's shading read these -> they are drawn again -> compute reads them.
void Renderer::recordPicture(VkCommandBuffer commands) {
  const Hop colorAgain{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, 0, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
  const Hop colorRead{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
  const VkPipelineStageFlags2 tests =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  const Hop depthAgain{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, 0, tests,
                       VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
  const Hop depthRead{tests, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                      VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
  const VkImageLayout unknown = VK_IMAGE_LAYOUT_UNDEFINED, read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  const VkImageLayout drawn = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  const VkImageLayout depthDrawn = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  transition(commands, normals, unknown, drawn, colorAgain);
  transition(commands, triangles, unknown, drawn, colorAgain);
  transition(commands, depth, unknown, depthDrawn, depthAgain);
  VkRenderingAttachmentInfo colors[2] = {{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO},
                                         {VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO}};
  for (int i = 0; i < 2; ++i) {
    colors[i].imageView = i == 0 ? normals.view : triangles.view;
    colors[i].imageLayout = drawn;
    colors[i].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    colors[i].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  }
  VkRenderingAttachmentInfo depthTarget = colors[0];
  depthTarget.imageView = depth.view;
  depthTarget.imageLayout = depthDrawn;  // cleared to 0, infinitely far
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea.extent = {kSide, kSide};
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 2;
  rendering.pColorAttachments = colors;
  rendering.pDepthAttachment = &depthTarget;
  vkCmdBeginRendering(commands, &rendering);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, draw_);
  drawRoom(commands, clipFromEye * eyeFromWorld(room_.worldFromEye), true);
  vkCmdEndRendering(commands);
  transition(commands, normals, drawn, read, colorRead);
  transition(commands, triangles, drawn, read, colorRead);
  transition(commands, depth, depthDrawn, read, depthRead);
  // Visibility and fog: the last frame's shading and readback read them -> compute, or a clear, writes them.
  const Hop again{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT, 0,
                  VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT,
                  VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT};
  transition(commands, visibility, unknown, VK_IMAGE_LAYOUT_GENERAL, again);
  transition(commands, fog, unknown, VK_IMAGE_LAYOUT_GENERAL, again);
  const VkClearColorValue none{};
  const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdClearColorImage(commands, fog.image, VK_IMAGE_LAYOUT_GENERAL, &none, 1, &whole);
}

void Renderer::recordShading(VkCommandBuffer commands, const glm::vec3& lightW, float fogPerMetre) {
  transition(
      commands, picture, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL,
      {VK_PIPELINE_STAGE_2_COPY_BIT, 0, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT});
  const float tanHalf = std::tan(0.5f * room_.yFovRad);
  const ShadePush push{room_.worldFromEye, glm::vec4(lightW, kLampCandela), glm::vec2(tanHalf), room_.zNear,
                       fogPerMetre};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, shade_);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, shadeLayout_, 0, 1, &set_, 0, nullptr);
  vkCmdPushConstants(commands, shadeLayout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
  vkCmdDispatch(commands, kSide / 8, kSide / 8, 1);
}

// Shading and Gnomon write -> the copy reads -> the CPU reads.
void Renderer::recordReadback(VkCommandBuffer commands) {
  const Hop copied{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT,
                   VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
                   VK_ACCESS_2_TRANSFER_READ_BIT};
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {kSide, kSide, 1};
  const GpuImage* images[] = {&picture, &visibility, &fog};
  const GpuBuffer* bytes[] = {&pictureBytes, &visibilityBytes, &fogBytes};
  for (int i = 0; i < 3; ++i) {
    transition(commands, *images[i], VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL, copied);
    vkCmdCopyImageToBuffer(commands, images[i]->image, VK_IMAGE_LAYOUT_GENERAL, bytes[i]->buffer, 1, &region);
  }
  VkMemoryBarrier2 toHost{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  toHost.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT, toHost.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  toHost.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT, toHost.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1, dependency.pMemoryBarriers = &toHost;
  vkCmdPipelineBarrier2(commands, &dependency);
}

void Renderer::submitAndWait(VkCommandBuffer commands) {
  VK(vkEndCommandBuffer(commands));
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = 1, info.pCommandBuffers = &commands;
  VK(vkQueueSubmit(gpu_.queue, 1, &info, fence_));
  VK(vkWaitForFences(gpu_.device, 1, &fence_, VK_TRUE, UINT64_MAX));
  VK(vkResetFences(gpu_.device, 1, &fence_));
}

void Renderer::stamp(VkCommandBuffer commands, uint32_t i) {
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, stamps_, i);
}

double Renderer::milliseconds(uint32_t from, uint32_t to) const {
  uint64_t ticks[2] = {};
  VK(vkGetQueryPoolResults(gpu_.device, stamps_, from, 1, 8, &ticks[0], 8, VK_QUERY_RESULT_64_BIT));
  VK(vkGetQueryPoolResults(gpu_.device, stamps_, to, 1, 8, &ticks[1], 8, VK_QUERY_RESULT_64_BIT));
  return static_cast<double>(ticks[1] - ticks[0]) * static_cast<double>(gpu_.nanosecondsPerTick) * 1e-6;
}
