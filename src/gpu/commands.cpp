#include "gpu/commands.h"

#include "base/check.h"
#include "base/error.h"
#include "gpu/pending_work.h"

#include <algorithm>
#include <array>
#include <chrono>

#include <fmt/format.h>

namespace gnomon::gpu {

namespace {

constexpr uint32_t kMaxStages = 64;
constexpr size_t kMostBindings = 48;  // of a program

void recordFullBarrier(VkCommandBuffer commands, VkPipelineStageFlags2 readers) {
  VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  memory.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  memory.dstStageMask = readers;
  memory.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &memory;
  vkCmdPipelineBarrier2(commands, &dependency);
}

bool takesBuffer(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER ||
         type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
}

const char* typeName(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return "storage buffer";
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
      return "uniform buffer";
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
      return "texel buffer";
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return "storage image";
    case VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT:
      return "input attachment";
    default:
      return "texture";
  }
}

const Binding* findBinding(const std::vector<Binding>& bindings, uint32_t index) {
  const auto found = std::find_if(bindings.begin(), bindings.end(),
                                  [index](const Binding& binding) { return binding.index == index; });
  return found == bindings.end() ? nullptr : &*found;
}

// Exactly the program's bindings, each with the right kind of resource; else aborts and says what is wrong.
void checkBindings(const Program& program, const std::vector<Binding>& given) {
  const std::vector<ProgramInterface::Binding>& declared = program.interface().bindings;
  for (const ProgramInterface::Binding& binding : declared) {
    const Binding* found = findBinding(given, binding.index);
    const char* is = !found ? "nothing" : found->buffer ? "buffer" : "image";
    const char* takes = takesBuffer(binding.type) ? "buffer" : "image";
    if (std::string_view(is) == takes) continue;
    GNOMON_CHECK_EQ(fmt::format("{} is given {} for binding {}", program.name(), is, binding.index),
                    fmt::format("{} '{}', which it declares", typeName(binding.type), binding.name));
  }
  for (const Binding& binding : given) {
    const bool known =
        std::any_of(declared.begin(), declared.end(), [&](const auto& other) { return other.index == binding.index; });
    if (known) continue;
    GNOMON_CHECK_EQ(fmt::format("{} is given binding {}", program.name(), binding.index),
                    fmt::format("the {} bindings that it declares, not this one", declared.size()));
  }
  if (given.size() != declared.size())
    GNOMON_CHECK_EQ(fmt::format("{} is given {} bindings, one of them twice", program.name(), given.size()),
                    fmt::format("the {} that it declares", declared.size()));
}

void checkPush(const Program& program, std::span<const std::byte> push) {
  if (push.size() == program.interface().pushConstantBytes) return;
  GNOMON_CHECK_EQ(fmt::format("{} is given {} bytes of push constants", program.name(), push.size()),
                  fmt::format("the {} bytes that it declares", program.interface().pushConstantBytes));
}

void recordPush(VkCommandBuffer commands, const Program& program, std::span<const std::byte> push) {
  checkPush(program, push);
  if (push.empty()) return;
  vkCmdPushConstants(commands, program.layout(), program.interface().pushConstantStages, 0,
                     static_cast<uint32_t>(push.size()), push.data());
}

// Binds the pipeline, every descriptor and the push constants.
void recordProgram(const Device& device, VkCommandBuffer commands, const Program& program,
                   std::span<const std::byte> push, const std::vector<Binding>& given) {
  GNOMON_CHECK(program.pipeline() != VK_NULL_HANDLE);
  checkBindings(program, given);
  vkCmdBindPipeline(commands, program.bindPoint(), program.pipeline());
  const std::vector<ProgramInterface::Binding>& declared = program.interface().bindings;
  // On the stack: this is what a frame does most.
  GNOMON_CHECK_LE(declared.size(), kMostBindings);
  std::array<VkDescriptorBufferInfo, kMostBindings> buffers;
  std::array<VkDescriptorImageInfo, kMostBindings> images;
  std::array<VkBufferView, kMostBindings> texels;
  std::array<VkWriteDescriptorSet, kMostBindings> writes;
  for (size_t i = 0; i < declared.size(); ++i) {
    const Binding& binding = *findBinding(given, declared[i].index);
    VkWriteDescriptorSet& write = writes[i];
    write = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstBinding = declared[i].index;
    write.descriptorCount = 1;
    write.descriptorType = declared[i].type;
    if (declared[i].type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) {
      GNOMON_CHECK(binding.buffer->view() != VK_NULL_HANDLE);
      texels[i] = binding.buffer->view();
      write.pTexelBufferView = &texels[i];
    } else if (binding.buffer) {
      GNOMON_CHECK(binding.buffer->handle() != VK_NULL_HANDLE);
      buffers[i] = {binding.buffer->handle(), 0, VK_WHOLE_SIZE};
      write.pBufferInfo = &buffers[i];
    } else {
      const VkImageView view = binding.layer ? binding.image->layerView(*binding.layer) : binding.image->view();
      GNOMON_CHECK(view != VK_NULL_HANDLE);
      images[i] = {VK_NULL_HANDLE, view, binding.image->layout()};
      write.pImageInfo = &images[i];
    }
  }
  if (!declared.empty())
    device.functions().pushDescriptorSet(commands, program.bindPoint(), program.layout(), 0,
                                         static_cast<uint32_t>(declared.size()), writes.data());
  recordPush(commands, program, push);
}

VkRenderingAttachmentInfo attachment(const Image& image, std::optional<uint32_t> layer,
                                     std::optional<VkClearValue> clear) {
  if (layer) GNOMON_CHECK_LT(*layer, image.desc().layerCount);
  VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  info.imageView = layer ? image.layerView(*layer) : image.view();
  info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  info.loadOp = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  if (clear) info.clearValue = *clear;
  return info;
}

VkBufferImageCopy wholeImage(const Image& image, VkDeviceSize bufferOffset) {
  VkBufferImageCopy region{};
  region.bufferOffset = bufferOffset;
  region.imageSubresource = {image.aspect(), 0, 0, image.desc().layerCount};
  region.imageExtent = {image.desc().width, image.desc().height, 1};
  return region;
}

VkExtent2D extentOf(const RenderTargets& targets) {
  const Image* first = targets.depth;
  for (const ColorTarget& color : targets.colors)
    if (first == nullptr) first = color.image;
  GNOMON_CHECK(first != nullptr);
  const VkExtent2D extent{first->desc().width, first->desc().height};
  for (const ColorTarget& color : targets.colors) {
    if (color.image == nullptr) continue;
    GNOMON_CHECK_EQ(color.image->desc().width, extent.width);
    GNOMON_CHECK_EQ(color.image->desc().height, extent.height);
  }
  return extent;
}

// Views, clears and formats of RenderTargets::ordered.
struct OrderedAttachments {
  OrderedPassDesc desc;
  std::vector<VkImageView> views;
  std::vector<VkClearValue> clears;

  explicit OrderedAttachments(const RenderTargets& targets) {
    size_t cleared = 0;
    const auto attach = [&](const Image& image, std::optional<VkClearValue> clear) {
      views.push_back(targets.layer ? image.layerView(*targets.layer) : image.view());
      clears.push_back(clear.value_or(VkClearValue{}));
      cleared += clear ? 1 : 0;
      return image.desc().format;
    };
    for (const ColorTarget& color : targets.colors) {
      std::optional<VkClearValue> clear;
      if (color.clear) clear = VkClearValue{.color = *color.clear};
      desc.colors.push_back(color.image != nullptr ? attach(*color.image, clear) : VK_FORMAT_UNDEFINED);
    }
    if (targets.depth) {
      std::optional<VkClearValue> clear;
      if (targets.clearDepth) clear = VkClearValue{.depthStencil = {*targets.clearDepth, 0}};
      desc.depth = attach(*targets.depth, clear);
    }
    GNOMON_CHECK(cleared == 0 || cleared == views.size());
    desc.clear = cleared > 0;
  }

  OrderedTargets::Made make(const Device& device, VkExtent2D extent, OrderedTargets& kept) const {
    return kept.get(device, desc, views, extent);
  }
};

}  // namespace

std::vector<Binding> declaredBy(const Program& program, std::vector<Binding> bindings) {
  std::erase_if(bindings, [&](const Binding& binding) {
    return std::ranges::none_of(program.interface().bindings,
                                [&](const auto& declared) { return declared.index == binding.index; });
  });
  return bindings;
}

Commands::Commands(const Device& device, const char* name) : device_(device) {
  GNOMON_CHECK(name != nullptr);
  GNOMON_CHECK(device.pending() == nullptr);  // what is borrowed is not submitted to
  VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  poolInfo.queueFamilyIndex = device.queueFamily();
  VkCommandPool pool = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateCommandPool(device.handle(), &poolInfo, nullptr, &pool));
  pool_ = {device.handle(), pool};
  VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateFence(device.handle(), &fenceInfo, nullptr, &fence));
  fence_ = {device.handle(), fence};
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  GNOMON_VK_CHECK(vkAllocateCommandBuffers(device.handle(), &info, &commands_));
  device.nameObject(VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<uint64_t>(commands_), name);
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  GNOMON_VK_CHECK(vkBeginCommandBuffer(commands_, &begin));
  barrier("earlier submissions write -> everything here reads");
}

Commands::Commands(const Device& device, VkCommandBuffer lent, const char* words)
    : device_(device), commands_(lent), lent_(true) {
  if (device.pending() != nullptr) device.pending()->record(lent);
  barrier(words);
}

Commands::~Commands() = default;

void Commands::beginStage(const char* name) {
  GNOMON_CHECK(name != nullptr);
  GNOMON_CHECK(!inStage_);
  GNOMON_CHECK(!inRendering_);
  GNOMON_CHECK_LT(stageNames_.size(), kMaxStages);
  if (!lent_ && !queries_ && device_.info().timestampValidBits > 0) {
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2 * kMaxStages;
    VkQueryPool queries = VK_NULL_HANDLE;
    GNOMON_VK_CHECK(vkCreateQueryPool(device_.handle(), &info, nullptr, &queries));
    queries_ = {device_.handle(), queries};
    vkResetQueryPool(device_.handle(), queries, 0, info.queryCount);
  }
  VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
  label.pLabelName = name;
  if (device_.functions().beginLabel) device_.functions().beginLabel(commands_, &label);
  if (queries_)
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(),
                         static_cast<uint32_t>(2 * stageNames_.size()));
  stageNames_.emplace_back(name);
  inStage_ = true;
}

void Commands::endStage() {
  GNOMON_CHECK(inStage_);
  GNOMON_CHECK(!inRendering_);
  if (queries_)
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(),
                         static_cast<uint32_t>(2 * stageNames_.size() - 1));
  if (device_.functions().endLabel) device_.functions().endLabel(commands_);
  inStage_ = false;
}

void Commands::barrier(const char* words) {
  GNOMON_CHECK(words != nullptr && *words != '\0');
  GNOMON_CHECK(!inRendering_);
  recordFullBarrier(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
}

void Commands::dispatch(const ComputeProgram& program, glm::uvec3 groupCount, std::span<const std::byte> push,
                        const std::vector<Binding>& bindings) {
  GNOMON_CHECK(!inRendering_);
  recordProgram(device_, commands_, program, push, bindings);
  vkCmdDispatch(commands_, groupCount.x, groupCount.y, groupCount.z);
}

void Commands::dispatchIndirect(const ComputeProgram& program, const Buffer& arguments, VkDeviceSize offset,
                                std::span<const std::byte> push, const std::vector<Binding>& bindings) {
  GNOMON_CHECK(!inRendering_);
  GNOMON_CHECK_LE(offset + sizeof(VkDispatchIndirectCommand), arguments.size());
  recordProgram(device_, commands_, program, push, bindings);
  vkCmdDispatchIndirect(commands_, arguments.handle(), offset);
}

void Commands::beginDynamic(const RenderTargets& targets, VkExtent2D extent) {
  std::vector<VkRenderingAttachmentInfo> colors;
  for (const ColorTarget& color : targets.colors) {
    std::optional<VkClearValue> clear;
    if (color.clear) clear = VkClearValue{.color = *color.clear};
    colors.push_back(color.image != nullptr ? attachment(*color.image, targets.layer, clear)
                                            : VkRenderingAttachmentInfo{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO});
  }
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea.extent = extent;
  info.layerCount = 1;  // ignored where there is a view mask
  info.viewMask = targets.viewMask;
  info.colorAttachmentCount = static_cast<uint32_t>(colors.size());
  info.pColorAttachments = colors.data();
  VkRenderingAttachmentInfo depth{};
  if (targets.depth) {
    std::optional<VkClearValue> clear;
    if (targets.clearDepth) clear = VkClearValue{.depthStencil = {*targets.clearDepth, 0}};
    depth = attachment(*targets.depth, targets.layer, clear);
    info.pDepthAttachment = &depth;
  }
  vkCmdBeginRendering(commands_, &info);
}

OrderedTargets::Made makeOrdered(const Device& device, const RenderTargets& targets, OrderedTargets& kept) {
  return OrderedAttachments(targets).make(device, extentOf(targets), kept);
}

void Commands::beginOrdered(const RenderTargets& targets, VkExtent2D extent) {
  GNOMON_CHECK(device_.info().orderedAttachmentAccess);
  GNOMON_CHECK_EQ(targets.viewMask, 0u);
  const OrderedAttachments attachments(targets);
  const std::vector<VkClearValue>& clears = attachments.clears;
  const OrderedTargets::Made made = attachments.make(device_, extent, targets.kept ? *targets.kept : ordered_);
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = made.pass;
  info.framebuffer = made.framebuffer;
  info.renderArea.extent = extent;
  info.clearValueCount = static_cast<uint32_t>(clears.size());
  info.pClearValues = clears.data();
  vkCmdBeginRenderPass(commands_, &info, VK_SUBPASS_CONTENTS_INLINE);
}

void Commands::beginRendering(const RenderTargets& targets) {
  GNOMON_CHECK(!inRendering_);
  const VkExtent2D extent = extentOf(targets);
  if (targets.ordered)
    beginOrdered(targets, extent);
  else
    beginDynamic(targets, extent);
  inRendering_ = true;
  inOrderedPass_ = targets.ordered;

  const VkViewport viewport{0.0f, 0.0f, static_cast<float>(extent.width), static_cast<float>(extent.height),
                            0.0f, 1.0f};
  const VkRect2D scissor{{0, 0}, extent};
  vkCmdSetViewport(commands_, 0, 1, &viewport);
  vkCmdSetScissor(commands_, 0, 1, &scissor);
  setCulling(VK_CULL_MODE_NONE, VK_FRONT_FACE_COUNTER_CLOCKWISE);
}

void Commands::bind(const GraphicsProgram& program, std::span<const std::byte> push,
                    const std::vector<Binding>& bindings) {
  GNOMON_CHECK(inRendering_);
  recordProgram(device_, commands_, program, push, bindings);
}

void Commands::push(const GraphicsProgram& program, std::span<const std::byte> push) {
  GNOMON_CHECK(inRendering_);
  recordPush(commands_, program, push);
}

void Commands::setCulling(VkCullModeFlags mode, VkFrontFace front) {
  vkCmdSetCullMode(commands_, mode);
  vkCmdSetFrontFace(commands_, front);
}

void Commands::bindIndexBuffer(const Buffer& buffer, VkDeviceSize offset, VkIndexType type) {
  vkCmdBindIndexBuffer(commands_, buffer.handle(), offset, type);
}

void Commands::bindVertexStream(const Buffer& stream, VkDeviceSize offset) {
  const VkBuffer handle = stream.handle();
  vkCmdBindVertexBuffers(commands_, 0, 1, &handle, &offset);
}

void Commands::bindVertexStreams(const std::vector<const Buffer*>& streams) {
  std::vector<VkBuffer> handles;
  for (const Buffer* stream : streams) handles.push_back(stream->handle());
  const std::vector<VkDeviceSize> offsets(handles.size(), 0);
  vkCmdBindVertexBuffers(commands_, 0, static_cast<uint32_t>(handles.size()), handles.data(), offsets.data());
}

void Commands::drawIndexed(uint32_t indexCount, uint32_t instanceCount, uint32_t firstIndex, int32_t vertexOffset,
                           uint32_t firstInstance) {
  GNOMON_CHECK(inRendering_);
  vkCmdDrawIndexed(commands_, indexCount, instanceCount, firstIndex, vertexOffset, firstInstance);
}

void Commands::draw(uint32_t vertexCount, uint32_t instanceCount, uint32_t firstVertex, uint32_t firstInstance) {
  GNOMON_CHECK(inRendering_);
  vkCmdDraw(commands_, vertexCount, instanceCount, firstVertex, firstInstance);
}

void Commands::drawIndirect(const Buffer& arguments) {
  GNOMON_CHECK(inRendering_);
  GNOMON_CHECK_LE(sizeof(VkDrawIndirectCommand), arguments.size());
  vkCmdDrawIndirect(commands_, arguments.handle(), 0, 1, sizeof(VkDrawIndirectCommand));
}

void Commands::endRendering() {
  GNOMON_CHECK(inRendering_);
  if (inOrderedPass_)
    vkCmdEndRenderPass(commands_);
  else
    vkCmdEndRendering(commands_);
  inRendering_ = false;
}

void Commands::fill(const Buffer& buffer, uint32_t word) {
  GNOMON_CHECK(!inRendering_);
  GNOMON_CHECK_EQ(buffer.size() % 4, 0u);
  vkCmdFillBuffer(commands_, buffer.handle(), 0, VK_WHOLE_SIZE, word);
}

void Commands::update(const Buffer& buffer, std::span<const std::byte> bytes, VkDeviceSize offset) {
  constexpr size_t kMostBytes = 65536;
  GNOMON_CHECK(!inRendering_);
  GNOMON_CHECK_LE(offset + bytes.size(), buffer.size());
  for (size_t done = 0; done < bytes.size(); done += kMostBytes) {
    const std::span<const std::byte> piece = bytes.subspan(done, std::min(kMostBytes, bytes.size() - done));
    vkCmdUpdateBuffer(commands_, buffer.handle(), offset + done, piece.size(), piece.data());
  }
}

void Commands::copy(const Buffer& from, const Buffer& to, VkDeviceSize size) {
  GNOMON_CHECK(!inRendering_);
  GNOMON_CHECK_LE(size, from.size());
  GNOMON_CHECK_LE(size, to.size());
  if (size == 0) return;
  const VkBufferCopy region{0, 0, size};
  vkCmdCopyBuffer(commands_, from.handle(), to.handle(), 1, &region);
}

void Commands::copy(const Image& from, const Buffer& to) {
  GNOMON_CHECK(!inRendering_);
  const VkBufferImageCopy region = wholeImage(from, 0);
  vkCmdCopyImageToBuffer(commands_, from.handle(), VK_IMAGE_LAYOUT_GENERAL, to.handle(), 1, &region);
}

void Commands::copy(const Buffer& from, const Image& to, VkDeviceSize fromOffset) {
  GNOMON_CHECK(!inRendering_);
  const VkBufferImageCopy region = wholeImage(to, fromOffset);
  vkCmdCopyBufferToImage(commands_, from.handle(), to.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &region);
}

Submission Commands::submitAndWait() {
  GNOMON_CHECK(!inStage_);
  GNOMON_CHECK(!inRendering_);
  GNOMON_CHECK(!submitted_);
  GNOMON_CHECK(!lent_);
  submitted_ = true;
  // A fence makes nothing visible to the CPU by itself: mapped memory needs the host as a reader.
  recordFullBarrier(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT);
  GNOMON_VK_CHECK(vkEndCommandBuffer(commands_));
  VkCommandBufferSubmitInfo commandsInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  commandsInfo.commandBuffer = commands_;
  VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &commandsInfo;
  const VkFence fence = fence_.get();
  const auto begin = std::chrono::steady_clock::now();
  GNOMON_VK_CHECK(vkQueueSubmit2(device_.queue(), 1, &info, fence));
  GNOMON_VK_CHECK(vkWaitForFences(device_.handle(), 1, &fence, VK_TRUE, UINT64_MAX));
  const auto end = std::chrono::steady_clock::now();
  Submission submission;
  submission.wallMs = std::chrono::duration<double, std::milli>(end - begin).count();
  submission.stages = readStages();
  return submission;
}

std::vector<StageTime> Commands::readStages() const {
  std::vector<StageTime> stages;
  std::vector<uint64_t> ticks(2 * stageNames_.size());
  if (queries_)
    GNOMON_VK_CHECK(vkGetQueryPoolResults(device_.handle(), queries_.get(), 0, static_cast<uint32_t>(ticks.size()),
                                          ticks.size() * sizeof(uint64_t), ticks.data(), sizeof(uint64_t),
                                          VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
  // Fewer than 64 valid bits wrap around, so the difference is taken within them.
  const uint32_t bits = device_.info().timestampValidBits;
  const uint64_t mask = bits >= 64 ? ~0ull : (1ull << bits) - 1;
  for (size_t i = 0; i < stageNames_.size(); ++i) {
    const uint64_t elapsed = (ticks[2 * i + 1] - ticks[2 * i]) & mask;
    stages.push_back({stageNames_[i], static_cast<double>(elapsed) * device_.info().timestampPeriod * 1e-6});
  }
  return stages;
}

}  // namespace gnomon::gpu
