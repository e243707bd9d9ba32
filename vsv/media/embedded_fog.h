#pragma once
// Light shafts of a homogeneous medium in a renderer of its own: what a point light scatters towards the eye, through
// the bits of a shadow volume, into an image of the renderer's. The model and its units are shared/medium.glsl's.

#include "vsv/embedded_volume.h"
#include "vsv/media/media_pass.h"

namespace gnomon {

struct EmbeddedFogDesc {
  int width = 0, height = 0;  // pixels
  ReceiverKind receivers = ReceiverKind::Depth;
  VkFormat scattered = VK_FORMAT_R16G16B16A16_SFLOAT;  // or R32G32B32A32_SFLOAT
};

class EmbeddedFog {
 public:
  // Of any volume like this one.
  EmbeddedFog(const gpu::Device& device, const EmbeddedVolume& volume, const EmbeddedFogDesc& desc);

  // The volume's bits and the renderer's picture -> `scattered` is written, cd/m^2, which the commands that follow may
  // read: a storage image of width x height in GENERAL. `add`: to what it holds, of another light.
  void record(VkCommandBuffer commands, const EmbeddedVolume& volume, const glsl::CameraView& camera,
              const ReceiverPicture& receivers, const glsl::Medium& medium, const MediaLightSource& light,
              VkImageView scattered, bool add = false);

 private:
  const gpu::Device& device_;
  EmbeddedFogDesc desc_;
  MediaMethod method_;
  MediaPass pass_;
};

}  // namespace gnomon
