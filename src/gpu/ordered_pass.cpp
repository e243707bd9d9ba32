#include "gpu/ordered_pass.h"

#include "gpu/device.h"

namespace gnomon::gpu {

OwnedChild<VkRenderPass, vkDestroyRenderPass> createOrderedPass(const Device& device, const OrderedPassDesc& desc) {
  std::vector<VkAttachmentDescription> attachments;
  const auto reference = [&](VkFormat format) -> VkAttachmentReference {
    if (format == VK_FORMAT_UNDEFINED) return {VK_ATTACHMENT_UNUSED, VK_IMAGE_LAYOUT_GENERAL};
    VkAttachmentDescription attachment{};
    attachment.format = format;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = desc.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachment.initialLayout = attachment.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
    attachments.push_back(attachment);
    return {static_cast<uint32_t>(attachments.size() - 1), VK_IMAGE_LAYOUT_GENERAL};
  };
  std::vector<VkAttachmentReference> colors;
  for (const VkFormat format : desc.colors) colors.push_back(reference(format));
  const VkAttachmentReference depth = reference(desc.depth);
  VkSubpassDescription subpass{};
  subpass.flags = VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_COLOR_ACCESS_BIT_EXT;
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = subpass.inputAttachmentCount = static_cast<uint32_t>(colors.size());
  subpass.pColorAttachments = subpass.pInputAttachments = colors.data();
  subpass.pDepthStencilAttachment = &depth;
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = static_cast<uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  VkRenderPass pass = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateRenderPass(device.handle(), &info, nullptr, &pass));
  return {device.handle(), pass};
}

OrderedTargets::Made OrderedTargets::get(const Device& device, const OrderedPassDesc& desc,
                                         const std::vector<VkImageView>& views, VkExtent2D extent) {
  for (const Entry& entry : entries_)
    if (entry.desc == desc && entry.views == views) return {entry.pass.get(), entry.framebuffer.get()};
  Entry made{.desc = desc, .views = views, .pass = createOrderedPass(device, desc), .framebuffer = {}};
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = made.pass.get();
  info.attachmentCount = static_cast<uint32_t>(views.size());
  info.pAttachments = views.data();
  info.width = extent.width;
  info.height = extent.height;
  info.layers = 1;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  GNOMON_VK_CHECK(vkCreateFramebuffer(device.handle(), &info, nullptr, &framebuffer));
  made.framebuffer = {device.handle(), framebuffer};
  entries_.push_back(std::move(made));
  return {entries_.back().pass.get(), entries_.back().framebuffer.get()};
}

}  // namespace gnomon::gpu
