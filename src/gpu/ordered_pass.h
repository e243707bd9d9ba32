#pragma once
// A render pass of the old kind whose fragments read the colours beneath them as input attachments, in the order of the
// triangles (VK_EXT_rasterization_order_attachment_access). Dynamic rendering has no input attachments in Vulkan 1.3.

#include "gpu/vulkan.h"

#include <vector>

namespace gnomon::gpu {

class Device;

struct OrderedPassDesc {
  std::vector<VkFormat> colors;  // VK_FORMAT_UNDEFINED where there is none; input attachments of the same numbers
  VkFormat depth = VK_FORMAT_UNDEFINED;
  bool clear = false;  // or else all attachments keep what is there
};

// Passes that differ in `clear` alone are compatible.
OwnedChild<VkRenderPass, vkDestroyRenderPass> createOrderedPass(const Device& device, const OrderedPassDesc& desc);

}  // namespace gnomon::gpu
