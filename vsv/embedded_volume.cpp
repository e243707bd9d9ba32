#include "vsv/embedded_volume.h"

#include "base/check.h"
#include "base/error.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

const EmbeddedVolumeDesc& checkedFor(const LentGeometry& geometry, const EmbeddedVolumeDesc& desc) {
  GNOMON_CHECK(desc.bias != nullptr);
  if (!desc.bias->onVolumes)
    throw WorldError(
        fmt::format("{} means nothing on a shadow volume; choose none, constant or adaptive", desc.bias->name));
  if (geometry.tables() == LentTables::None)
    throw WorldError("volumes read single triangles: make the geometry with LentTables::Triangles");
  return desc;
}

gpu::Image lentStorage(VkImageView view, VkFormat format) {
  return {view, VK_IMAGE_LAYOUT_GENERAL, {.name = "lent visibility", .format = format}};
}

}  // namespace

EmbeddedVolume::EmbeddedVolume(const gpu::Device& device, const LentGeometry& geometry, const EmbeddedVolumeDesc& desc)
    : device_(device),
      geometry_(geometry),
      desc_(checkedFor(geometry, desc)),
      volume_(device, desc.columns),
      renderer_(device),
      pass_(device, desc.width, desc.height, VisibilityPass::Output::Images) {
  volume_.prepare(renderer_, geometry.buffers());
  const gpu::Image into = lentStorage(VK_NULL_HANDLE, desc.visibility);
  ShadowVolume::visibilityProgram(geometry.buffers(), desc.receivers, pass_, {.bias = *desc.bias, .into = &into});
}

void EmbeddedVolume::recordView(VkCommandBuffer lent, const FittedMap& columns, const LightModel& light) {
  gpu::Commands commands(device_, lent, "earlier frames read the volume's numbers -> they are written");
  volume_.recordFit(commands, columns);
  desc_.light = light;
}

void EmbeddedVolume::recordVolume(VkCommandBuffer lent) {
  gpu::Commands commands(device_, lent, "the renderer writes vertices, earlier frames read the bits -> they are made");
  volume_.recordDrawing(commands, renderer_, geometry_.buffers(), desc_.light, desc_.cull);
}

void EmbeddedVolume::recordVisibility(VkCommandBuffer lent, const glsl::CameraView& camera,
                                      const ReceiverPicture& receivers, VkImageView visibility) {
  GNOMON_CHECK(receivers.kind() == desc_.receivers);
  const gpu::Image into = lentStorage(visibility, desc_.visibility);
  gpu::Commands commands(device_, lent, "the bits and the renderer's picture are written -> visibility reads them");
  pass_.recordUniforms(commands, shadeUniforms(camera, desc_.light, desc_.params), receivers.meaning());
  volume_.recordVisibility(commands, geometry_.buffers(), receivers, pass_, {.bias = *desc_.bias, .into = &into});
  commands.barrier("visibility is written -> the renderer's shading reads it");
}

}  // namespace gnomon
