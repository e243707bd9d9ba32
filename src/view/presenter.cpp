#include "view/presenter.h"

#include "base/check.h"
#include "base/error.h"
#include "gpu/commands.h"

#include <algorithm>
#include <cstring>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_vulkan.h>
#include <fmt/format.h>
#include <imgui.h>
#include <vulkan/vulkan.h>

namespace gnomon {

namespace {

using gpu::OwnedChild;

// How long a window may keep an image to itself, and how long drawing it may take, nanoseconds.
constexpr uint64_t kAcquireNs = 1'000'000'000, kDrawNs = 30'000'000'000;

gpu::DeviceOptions optionsFor(const std::string& name) {
  uint32_t count = 0;
  const char** extensions = glfwGetRequiredInstanceExtensions(&count);
  if (extensions == nullptr)
    throw WorldError("the window system has no Vulkan surfaces; install libvulkan1 and an X or Wayland server");
  return {.name = name,
          .instanceExtensions = {extensions, extensions + count},
          .deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME}};
}

void checkResult(VkResult result) {
  if (result < 0) gpu::throwVulkanError(result, "a call of the user interface");
}

template <typename Handle, auto Destroy, typename Create, typename Info>
OwnedChild<Handle, Destroy> made(VkDevice device, Create create, const Info& info) {
  Handle handle = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(create(device, &info, nullptr, &handle));
  return {device, handle};
}

OwnedChild<VkSemaphore, vkDestroySemaphore> semaphore(VkDevice device) {
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  return made<VkSemaphore, vkDestroySemaphore>(device, vkCreateSemaphore, info);
}

// Eight bits a channel, as they are: pictures are in sRGB already.
VkSurfaceFormatKHR chooseFormat(VkPhysicalDevice device, VkSurfaceKHR surface) {
  uint32_t count = 0;
  GNOMON_VK_CHECK(vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, nullptr));
  std::vector<VkSurfaceFormatKHR> formats(count);
  GNOMON_VK_CHECK(vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, formats.data()));
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
    for (const VkSurfaceFormatKHR& format : formats)
      if (format.format == wanted) return format;
  throw WorldError("the window has no surface of 8 bits a channel; choose another device with --device");
}

// Without tearing and without waiting, where there is such a mode.
VkPresentModeKHR chooseMode(VkPhysicalDevice device, VkSurfaceKHR surface) {
  uint32_t count = 0;
  GNOMON_VK_CHECK(vkGetPhysicalDeviceSurfacePresentModesKHR(device, surface, &count, nullptr));
  std::vector<VkPresentModeKHR> modes(count);
  GNOMON_VK_CHECK(vkGetPhysicalDeviceSurfacePresentModesKHR(device, surface, &count, modes.data()));
  return std::ranges::find(modes, VK_PRESENT_MODE_MAILBOX_KHR) != modes.end() ? VK_PRESENT_MODE_MAILBOX_KHR
                                                                              : VK_PRESENT_MODE_FIFO_KHR;
}

// It keeps what is there, the pictures, and begins and ends as a colour attachment: barriers do the rest.
OwnedChild<VkRenderPass, vkDestroyRenderPass> createRenderPass(VkDevice device, VkFormat format) {
  VkAttachmentDescription color{};
  color.format = format;
  color.samples = VK_SAMPLE_COUNT_1_BIT;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  color.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  color.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 1;
  info.pAttachments = &color;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  return made<VkRenderPass, vkDestroyRenderPass>(device, vkCreateRenderPass, info);
}

struct ImageUse {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;
};
constexpr ImageUse kAcquired{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED};
constexpr ImageUse kCopiedTo{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
constexpr ImageUse kDrawnTo{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                            VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
constexpr ImageUse kCopiedFrom{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
constexpr ImageUse kPresented{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};

constexpr VkImageSubresourceRange kWholeColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
constexpr VkImageSubresourceLayers kColorLayer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

void barrier(VkCommandBuffer commands, VkImage image, const ImageUse& from, const ImageUse& to) {
  VkImageMemoryBarrier2 one{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  one.srcStageMask = from.stages;
  one.srcAccessMask = from.access;
  one.dstStageMask = to.stages;
  one.dstAccessMask = to.access;
  one.oldLayout = from.layout;
  one.newLayout = to.layout;
  one.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  one.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  one.image = image;
  one.subresourceRange = kWholeColor;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &one;
  vkCmdPipelineBarrier2(commands, &info);
}

void memoryBarrier(VkCommandBuffer commands, VkAccessFlags2 from, VkAccessFlags2 to) {
  VkMemoryBarrier2 one{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  one.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
  one.srcAccessMask = from;
  one.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
  one.dstAccessMask = to;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &one;
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

Presenter::Presenter(GLFWwindow* window, const std::string& device)
    : window_(window), device_(gpu::Device::create(optionsFor(device))) {
  GNOMON_VK_CHECK(glfwCreateWindowSurface(device_->instance(), window, nullptr, &surface_));
  VkBool32 presents = VK_FALSE;
  GNOMON_VK_CHECK(
      vkGetPhysicalDeviceSurfaceSupportKHR(device_->physical(), device_->queueFamily(), surface_, &presents));
  if (presents != VK_TRUE)
    throw WorldError(
        fmt::format("device '{}' cannot show a window; choose another with --device", device_->info().name));
  format_ = chooseFormat(device_->physical(), surface_);
  mode_ = chooseMode(device_->physical(), surface_);
  VkDevice handle = device_->handle();
  renderPass_ = createRenderPass(handle, format_.format);
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = device_->queueFamily();
  pool_ = made<VkCommandPool, vkDestroyCommandPool>(handle, vkCreateCommandPool, pool);
  VkCommandBufferAllocateInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  buffer.commandPool = pool_.get();
  buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  buffer.commandBufferCount = 1;
  GNOMON_VK_CHECK(vkAllocateCommandBuffers(handle, &buffer, &commands_));
  fence_ = made<VkFence, vkDestroyFence>(handle, vkCreateFence, VkFenceCreateInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO});
  acquired_ = semaphore(handle);
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4};
  VkDescriptorPoolCreateInfo descriptors{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  descriptors.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  descriptors.maxSets = 4;
  descriptors.poolSizeCount = 1;
  descriptors.pPoolSizes = &size;
  descriptors_ = made<VkDescriptorPool, vkDestroyDescriptorPool>(handle, vkCreateDescriptorPool, descriptors);

  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = device_->instance();
  info.PhysicalDevice = device_->physical();
  info.Device = handle;
  info.QueueFamily = device_->queueFamily();
  info.Queue = device_->queue();
  info.DescriptorPool = descriptors_.get();
  info.MinImageCount = 2;
  info.ImageCount = 2;
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = checkResult;
  ImGui_ImplVulkan_Init(&info, renderPass_.get());
  gpu::Commands fonts(*device_, "fonts");
  ImGui_ImplVulkan_CreateFontsTexture(fonts.handle());
  fonts.submitAndWait();
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Presenter::~Presenter() {
  vkDeviceWaitIdle(device_->handle());
  ImGui_ImplVulkan_Shutdown();
  destroySwapchain();
  vkDestroySurfaceKHR(device_->instance(), surface_, nullptr);
}

void Presenter::createSwapchain() {
  VkSurfaceCapabilitiesKHR can{};
  GNOMON_VK_CHECK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_->physical(), surface_, &can));
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  extent_ = can.currentExtent;
  if (extent_.width == UINT32_MAX)
    extent_ = {std::clamp(static_cast<uint32_t>(width), can.minImageExtent.width, can.maxImageExtent.width),
               std::clamp(static_cast<uint32_t>(height), can.minImageExtent.height, can.maxImageExtent.height)};
  if (extent_.width == 0 || extent_.height == 0) return;
  VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
  info.surface = surface_;
  info.minImageCount = std::max(can.minImageCount, 2u);
  if (can.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage =
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  if ((can.supportedUsageFlags & info.imageUsage) != info.imageUsage)
    throw WorldError("the window's surface takes no copies; choose another device with --device");
  info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
  info.preTransform = can.currentTransform;
  info.compositeAlpha = (can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
                            ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                            : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  info.presentMode = mode_;
  info.clipped = VK_TRUE;
  VkDevice handle = device_->handle();
  {
    std::shared_lock beside(gpu::loaderLists());
    GNOMON_VK_CHECK(vkCreateSwapchainKHR(handle, &info, nullptr, &swapchain_));
  }
  uint32_t count = 0;
  GNOMON_VK_CHECK(vkGetSwapchainImagesKHR(handle, swapchain_, &count, nullptr));
  std::vector<VkImage> images(count);
  GNOMON_VK_CHECK(vkGetSwapchainImagesKHR(handle, swapchain_, &count, images.data()));
  for (VkImage image : images) {
    Target& target = targets_.emplace_back();
    target.image = image;
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = kWholeColor;
    target.view = made<VkImageView, vkDestroyImageView>(handle, vkCreateImageView, view);
    VkImageView attachment = target.view.get();
    VkFramebufferCreateInfo framebuffer{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    framebuffer.renderPass = renderPass_.get();
    framebuffer.attachmentCount = 1;
    framebuffer.pAttachments = &attachment;
    framebuffer.width = extent_.width;
    framebuffer.height = extent_.height;
    framebuffer.layers = 1;
    target.framebuffer = made<VkFramebuffer, vkDestroyFramebuffer>(handle, vkCreateFramebuffer, framebuffer);
    target.drawn = semaphore(handle);
  }
}

void Presenter::destroySwapchain() {
  vkDeviceWaitIdle(device_->handle());
  targets_.clear();
  if (swapchain_ != VK_NULL_HANDLE) vkDestroySwapchainKHR(device_->handle(), swapchain_, nullptr);
  swapchain_ = VK_NULL_HANDLE;
}

void Presenter::setPicture(int index, const Image8& image) {
  GNOMON_CHECK_EQ(image.channels, 3);
  Slot& slot = slots_[static_cast<size_t>(index)];
  const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (pixels == 0) return;
  if (slot.width != image.width || slot.height != image.height) {
    slot.image = gpu::Image(*device_, {.name = "picture",
                                       .format = VK_FORMAT_R8G8B8A8_UNORM,
                                       .width = static_cast<uint32_t>(image.width),
                                       .height = static_cast<uint32_t>(image.height),
                                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    slot.staging =
        gpu::Buffer(*device_, {.name = "picture staging", .size = 4 * pixels, .memory = gpu::Memory::Readback});
    slot.width = image.width;
    slot.height = image.height;
  }
  auto* to = reinterpret_cast<uint8_t*>(slot.staging.mapped());
  const uint8_t* from = image.values.data();
  for (size_t i = 0; i < pixels; ++i, from += 3, to += 4) {
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
    to[3] = 255;
  }
  slot.changed = true;
}

void Presenter::record(const std::vector<Shown>& pictures, ImDrawData* interface, uint32_t index, bool keep) {
  Target& target = targets_[index];
  GNOMON_VK_CHECK(vkResetCommandBuffer(commands_, 0));
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  GNOMON_VK_CHECK(vkBeginCommandBuffer(commands_, &begin));
  barrier(commands_, target.image, kAcquired, kCopiedTo);
  const VkClearColorValue background{{0.11f, 0.11f, 0.12f, 1.0f}};
  vkCmdClearColorImage(commands_, target.image, kCopiedTo.layout, &background, 1, &kWholeColor);
  for (Slot& slot : slots_) {
    if (!slot.changed) continue;
    VkBufferImageCopy copy{};
    copy.imageSubresource = kColorLayer;
    copy.imageExtent = {static_cast<uint32_t>(slot.width), static_cast<uint32_t>(slot.height), 1};
    vkCmdCopyBufferToImage(commands_, slot.staging.handle(), slot.image.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    slot.changed = false;
  }
  memoryBarrier(commands_, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
  for (const Shown& shown : pictures) {
    const Slot& slot = slots_[static_cast<size_t>(shown.slot)];
    const PixelRect& from = shown.from;
    const PixelRect& to = shown.to;
    const bool fits = from.width > 0 && from.height > 0 && from.x + from.width <= slot.width &&
                      from.y + from.height <= slot.height && to.width > 0 && to.height > 0 && to.x >= 0 && to.y >= 0 &&
                      to.x + to.width <= static_cast<int>(extent_.width) &&
                      to.y + to.height <= static_cast<int>(extent_.height);
    if (!fits) continue;
    VkImageBlit blit{};
    blit.srcSubresource = kColorLayer;
    blit.srcOffsets[0] = {from.x, from.y, 0};
    blit.srcOffsets[1] = {from.x + from.width, from.y + from.height, 1};
    blit.dstSubresource = kColorLayer;
    blit.dstOffsets[0] = {to.x, to.y, 0};
    blit.dstOffsets[1] = {to.x + to.width, to.y + to.height, 1};
    vkCmdBlitImage(commands_, slot.image.handle(), VK_IMAGE_LAYOUT_GENERAL, target.image, kCopiedTo.layout, 1, &blit,
                   VK_FILTER_NEAREST);
  }
  barrier(commands_, target.image, kCopiedTo, kDrawnTo);
  VkRenderPassBeginInfo pass{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  pass.renderPass = renderPass_.get();
  pass.framebuffer = target.framebuffer.get();
  pass.renderArea.extent = extent_;
  vkCmdBeginRenderPass(commands_, &pass, VK_SUBPASS_CONTENTS_INLINE);
  ImGui_ImplVulkan_RenderDrawData(interface, commands_);
  vkCmdEndRenderPass(commands_);
  if (keep) {
    const VkDeviceSize bytes = VkDeviceSize{4} * extent_.width * extent_.height;
    if (readback_.size() != bytes)
      readback_ = gpu::Buffer(*device_, {.name = "window readback", .size = bytes, .memory = gpu::Memory::Readback});
    barrier(commands_, target.image, kDrawnTo, kCopiedFrom);
    VkBufferImageCopy copy{};
    copy.imageSubresource = kColorLayer;
    copy.imageExtent = {extent_.width, extent_.height, 1};
    vkCmdCopyImageToBuffer(commands_, target.image, kCopiedFrom.layout, readback_.handle(), 1, &copy);
    memoryBarrier(commands_, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_ACCESS_2_HOST_READ_BIT);
    barrier(commands_, target.image, kCopiedFrom, kPresented);
  } else {
    barrier(commands_, target.image, kDrawnTo, kPresented);
  }
  GNOMON_VK_CHECK(vkEndCommandBuffer(commands_));
}

void Presenter::present(const std::vector<Shown>& pictures, ImDrawData* interface, bool keep) {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  if (width <= 0 || height <= 0) return;
  if (swapchain_ != VK_NULL_HANDLE &&
      (extent_.width != static_cast<uint32_t>(width) || extent_.height != static_cast<uint32_t>(height)))
    destroySwapchain();
  if (swapchain_ == VK_NULL_HANDLE) createSwapchain();
  if (swapchain_ == VK_NULL_HANDLE) return;
  VkDevice handle = device_->handle();
  uint32_t index = 0;
  const VkResult got = vkAcquireNextImageKHR(handle, swapchain_, kAcquireNs, acquired_.get(), VK_NULL_HANDLE, &index);
  if (got == VK_TIMEOUT || got == VK_NOT_READY) return;            // nothing is shown of it now: it is hidden
  if (got == VK_ERROR_OUT_OF_DATE_KHR) return destroySwapchain();  // the next frame makes another
  if (got != VK_SUCCESS && got != VK_SUBOPTIMAL_KHR) gpu::throwVulkanError(got, "vkAcquireNextImageKHR");
  record(pictures, interface, index, keep);
  VkSemaphore acquired = acquired_.get(), drawn = targets_[index].drawn.get();
  const VkPipelineStageFlags waits = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.waitSemaphoreCount = 1;
  submit.pWaitSemaphores = &acquired;
  submit.pWaitDstStageMask = &waits;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands_;
  submit.signalSemaphoreCount = 1;
  submit.pSignalSemaphores = &drawn;
  VkFence fence = fence_.get();
  GNOMON_VK_CHECK(vkResetFences(handle, 1, &fence));
  GNOMON_VK_CHECK(vkQueueSubmit(device_->queue(), 1, &submit, fence));
  VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &drawn;
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &index;
  const VkResult shown = vkQueuePresentKHR(device_->queue(), &info);
  if (const VkResult done = vkWaitForFences(handle, 1, &fence, VK_TRUE, kDrawNs); done != VK_SUCCESS)
    gpu::throwVulkanError(done == VK_TIMEOUT ? VK_ERROR_DEVICE_LOST : done, "vkWaitForFences");
  if (keep) {
    kept_ = Image8(static_cast<int>(extent_.width), static_cast<int>(extent_.height), 3);
    const bool bgr = format_.format == VK_FORMAT_B8G8R8A8_UNORM;
    const auto* from = reinterpret_cast<const uint8_t*>(readback_.mapped());
    for (size_t i = 0; i < kept_.values.size() / 3; ++i)
      for (size_t c = 0; c < 3; ++c) kept_.values[3 * i + c] = from[4 * i + (bgr ? 2 - c : c)];
  }
  if (shown == VK_ERROR_OUT_OF_DATE_KHR) return destroySwapchain();
  if (shown != VK_SUCCESS && shown != VK_SUBOPTIMAL_KHR) gpu::throwVulkanError(shown, "vkQueuePresentKHR");
}

}  // namespace gnomon
