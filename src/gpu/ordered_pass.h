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
  bool operator==(const OrderedPassDesc&) const = default;
};

// Passes and framebuffers by what they draw to, each made when it is first asked for. The views must stay.
class OrderedTargets {
 public:
  struct Made {
    VkRenderPass pass = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
  };
  Made get(const Device& device, const OrderedPassDesc& desc, const std::vector<VkImageView>& views, VkExtent2D extent);

 private:
  struct Entry {
    OrderedPassDesc desc;
    std::vector<VkImageView> views;
    OwnedChild<VkRenderPass, vkDestroyRenderPass> pass;
    OwnedChild<VkFramebuffer, vkDestroyFramebuffer> framebuffer;
  };
  std::vector<Entry> entries_;
};

// Passes that differ in `clear` alone are compatible.
OwnedChild<VkRenderPass, vkDestroyRenderPass> createOrderedPass(const Device& device, const OrderedPassDesc& desc);

}  // namespace gnomon::gpu
