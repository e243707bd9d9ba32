#include "shadow/embedded_shadow.h"

#include "base/check.h"
#include "base/error.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

// Before anything is made.
const EmbeddedShadowDesc& checkedFor(const LentGeometry& geometry, const EmbeddedShadowDesc& desc) {
  GNOMON_CHECK(desc.bias != nullptr);
  GNOMON_CHECK(desc.width > 0 && desc.height > 0);
  const bool ids = (desc.bias->channels & (glsl::kChannelIds | glsl::kChannelSecondIds)) != 0;
  if (ids && desc.receivers == ReceiverKind::Depth)
    throw WorldError(fmt::format("{} asks which triangle a pixel sees: give it a picture of triangles, not of depth",
                                 desc.bias->name));
  if (desc.bias->knowsSurfaces() && geometry.tables() != LentTables::Surfaces)
    throw WorldError(fmt::format("{} follows surfaces: make the geometry with LentTables::Surfaces", desc.bias->name));
  if ((desc.receivers == ReceiverKind::Triangles || *desc.fit.shaders.bounds != '\0') &&
      geometry.tables() == LentTables::None)
    throw WorldError(
        "receivers by their triangle, paraboloids and volumes read single triangles: make the geometry with "
        "LentTables::Triangles");
  return desc;
}

gpu::Image lentStorage(VkImageView view, VkFormat format) {
  return {view, VK_IMAGE_LAYOUT_GENERAL, {.name = "lent visibility", .format = format}};
}

}  // namespace

EmbeddedShadow::EmbeddedShadow(const gpu::Device& device, const LentGeometry& geometry, const EmbeddedShadowDesc& desc)
    : device_(device),
      geometry_(geometry),
      desc_(checkedFor(geometry, desc)),
      map_(device, desc.fit, desc.bias->channels),
      renderer_(device),
      pass_(device, desc.width, desc.height, VisibilityPass::Output::Images) {
  GNOMON_CHECK(desc.fit.shaders.passes == SlicePasses::Each);
  pass_.setUniforms(shadeUniforms({}, desc.light, desc.params));
  renderer_.prepare(geometry.buffers(), map_);
  const gpu::Image into = lentStorage(VK_NULL_HANDLE, desc.visibility);
  pass_.prepare(geometry.buffers(), desc.receivers, map_, {.bias = *desc.bias, .filter = desc.filter, .into = &into});
}

void EmbeddedShadow::recordLight(VkCommandBuffer lent, const FittedMap& fit, const LightModel& light) {
  gpu::Commands commands(device_, lent, "earlier frames read the map's numbers -> they are written");
  map_.recordFit(commands, fit);
  desc_.light = light;
}

void EmbeddedShadow::recordMap(VkCommandBuffer lent) {
  gpu::Commands commands(device_, lent, "the renderer writes vertices, earlier frames read the map -> it is drawn");
  map_.recordDrawing(commands, renderer_, geometry_.buffers(), desc_.light, desc_.cull);
  commands.barrier("the map is drawn -> look-ups read it");
}

void EmbeddedShadow::recordMap(VkCommandBuffer lent, const DrawSlice& draw) {
  gpu::Commands commands(device_, lent, "the renderer writes vertices, earlier frames read the map -> it is drawn");
  renderer_.recordDrawnBy(commands, map_, draw);
  commands.barrier("the map is drawn -> look-ups read it");
}

void EmbeddedShadow::recordVisibility(VkCommandBuffer lent, const glsl::CameraView& camera,
                                      const ReceiverPicture& receivers, VkImageView visibility) {
  GNOMON_CHECK(receivers.kind() == desc_.receivers);
  GNOMON_CHECK_EQ(camera.width, desc_.width);
  GNOMON_CHECK_EQ(camera.height, desc_.height);
  const gpu::Image into = lentStorage(visibility, desc_.visibility);
  gpu::Commands commands(device_, lent, "the map and the renderer's picture are written -> visibility reads them");
  pass_.recordUniforms(commands, shadeUniforms(camera, desc_.light, desc_.params), receivers.meaning());
  map_.recordVisibility(commands, geometry_.buffers(), receivers, pass_,
                        {.bias = *desc_.bias, .filter = desc_.filter, .into = &into});
  commands.barrier("visibility is written -> the renderer's shading reads it");
}

}  // namespace gnomon
