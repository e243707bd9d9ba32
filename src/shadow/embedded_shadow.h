#pragma once
// The shadow of one light in a renderer of its own: a map and its look-up on the renderer's device, recorded into its
// command buffers. The constructor makes all there is; afterwards nothing is made, submitted or waited for.
//
//   auto device = gpu::Device::borrow({.instance = ..., .physical = ..., .device = ..., .queueFamily = ...});
//   LentGeometry geometry(*device, {...});
//   EmbeddedShadow shadow(*device, geometry, {.fit = makeCubeMap(...), ...});
//   each frame: shadow.recordMap(commands); shadow.recordVisibility(commands, camera, receivers, image);
//
// Barriers: every record function waits for all that was recorded before it, and all that is recorded after waits for
// what it wrote. Layouts of its images are the renderer's affair. docs/embed.md has the whole story.

#include "scene/lent_geometry.h"
#include "shadow/visibility_pass.h"

namespace gnomon {

struct EmbeddedShadowDesc {
  FittedMap fit;
  LightModel light;
  const BiasMethod* bias = nullptr;  // findBias("adaptive")
  glsl::BiasParams params;           // defaultBiasParams(*bias, the scene's diagonal)
  ChosenFilter filter = glsl::kShadowFilterNone;
  int width = 0, height = 0;  // pixels
  ReceiverKind receivers = ReceiverKind::Depth;
  VkFormat visibility = VK_FORMAT_R8_UNORM;  // or R16_SFLOAT, R32_SFLOAT
  CullMode cull = CullMode::Solids;
};

class EmbeddedShadow {
 public:
  // `geometry` may be empty where the renderer draws the map itself. Throws WorldError where the device cannot hold the
  // map, or the bias asks for tables that the geometry does not keep or for receivers that know their triangle.
  EmbeddedShadow(const gpu::Device& device, const LentGeometry& geometry, const EmbeddedShadowDesc& desc);

  // Another place or range of the same map (its kind, slices and size), for the commands that follow.
  void recordLight(VkCommandBuffer commands, const FittedMap& fit, const LightModel& light);

  // The renderer's writes to vertices and matrices -> the map is drawn.
  void recordMap(VkCommandBuffer commands);
  // The same by the renderer: `draw` is called once a slice (shadow/map_image.h). Of one layer.
  void recordMap(VkCommandBuffer commands, const DrawSlice& draw);

  // The map and the renderer's picture -> `visibility` is written, which the commands that follow may read: 1 lit, 0
  // not. A storage image of width x height in GENERAL, of the format that was named.
  void recordVisibility(VkCommandBuffer commands, const glsl::CameraView& camera, const ReceiverPicture& receivers,
                        VkImageView visibility);

  // For shading of its own: map().uniforms() is what shared/map.glsl declares as MapUniforms, image() an array of
  // slices in GENERAL.
  const MapImage& map() const { return map_; }

 private:
  const gpu::Device& device_;
  const LentGeometry& geometry_;
  EmbeddedShadowDesc desc_;
  MapImage map_;
  MapRenderer renderer_;
  VisibilityPass pass_;
};

}  // namespace gnomon
