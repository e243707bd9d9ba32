#include "vsv/media/embedded_fog.h"

#include "base/check.h"

namespace gnomon {

namespace {

gpu::Image lentStorage(VkImageView view, VkFormat format) {
  return {view, VK_IMAGE_LAYOUT_GENERAL, {.name = "lent scattered light", .format = format}};
}

}  // namespace

EmbeddedFog::EmbeddedFog(const gpu::Device& device, const EmbeddedVolume& volume, const EmbeddedFogDesc& desc)
    : device_(device),
      desc_(desc),
      method_(mediaMethod("runs")),
      pass_(device, desc.width, desc.height, MediaPass::Output::Images) {
  const gpu::Image into = lentStorage(VK_NULL_HANDLE, desc.scattered);
  pass_.prepare(volume.geometry().buffers(), desc.receivers, volume.volume(), method_, &into);
}

void EmbeddedFog::record(VkCommandBuffer lent, const EmbeddedVolume& volume, const glsl::CameraView& camera,
                         const ReceiverPicture& receivers, const glsl::Medium& medium, const MediaLightSource& light,
                         VkImageView scattered, bool add) {
  GNOMON_CHECK(receivers.kind() == desc_.receivers);
  const gpu::Image into = lentStorage(scattered, desc_.scattered);
  gpu::Commands commands(device_, lent, "the bits and the renderer's picture are written -> view rays read them");
  pass_.recordMedium(commands, camera, medium, receivers.meaning());
  pass_.recordTable(commands, volume.volume(), light);
  commands.barrier("the running integral is tabulated -> view rays read it");
  pass_.record(commands, volume.geometry().buffers(), receivers, volume.volume(), light, method_, add, &into);
  commands.barrier("scattered light is written -> the renderer reads it");
}

}  // namespace gnomon
