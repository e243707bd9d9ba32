#pragma once
// A shadow volume in a renderer of its own, as shadow/embedded_shadow.h has a map: recorded into the renderer's command
// buffers, of its meshes, for its depth buffer. The volume spans what the camera sees, so that its fit is another for
// each frame.
//
// Barriers: every record function waits for all that was recorded before it, and all that is recorded after waits for
// what it wrote.

#include "scene/lent_geometry.h"
#include "shadow/visibility_pass.h"
#include "vsv/shadow_volume.h"

namespace gnomon {

struct EmbeddedVolumeDesc {
  FittedMap columns;  // makeVolume()
  LightModel light;
  const BiasMethod* bias = nullptr;  // one that means something on bits: none, constant, adaptive
  glsl::BiasParams params;
  int width = 0, height = 0;  // pixels
  ReceiverKind receivers = ReceiverKind::Depth;
  VkFormat visibility = VK_FORMAT_R8_UNORM;  // or R16_SFLOAT, R32_SFLOAT
  CullMode cull = CullMode::Solids;
};

class EmbeddedVolume {
 public:
  // `geometry` keeps LentTables::Triangles. Throws WorldError where the device cannot hold the volume, and what it asks
  // for is not there.
  EmbeddedVolume(const gpu::Device& device, const LentGeometry& geometry, const EmbeddedVolumeDesc& desc);

  // Where the camera or the light has moved: a fit of the same size.
  void recordView(VkCommandBuffer commands, const FittedMap& columns, const LightModel& light);
  // The renderer's writes to vertices and matrices -> the volume is filled.
  void recordVolume(VkCommandBuffer commands);
  // As EmbeddedShadow::recordVisibility.
  void recordVisibility(VkCommandBuffer commands, const glsl::CameraView& camera, const ReceiverPicture& receivers,
                        VkImageView visibility);

  const ShadowVolume& volume() const { return volume_; }
  const LentGeometry& geometry() const { return geometry_; }

 private:
  const gpu::Device& device_;
  const LentGeometry& geometry_;
  EmbeddedVolumeDesc desc_;
  ShadowVolume volume_;
  MapRenderer renderer_;
  VisibilityPass pass_;
};

}  // namespace gnomon
