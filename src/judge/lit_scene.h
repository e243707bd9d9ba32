#pragma once
// All that stands around a shadow map in a program that wants a picture: a scene on a device, its first
// camera and its first light with a place, and the passes before and after the map's own.

#include "shadow/visibility_pass.h"

#include "base/image.h"

#include <functional>

namespace gnomon {

class LitScene {
 public:
  // Throws WorldError where the scene has no camera or no such light. The scene must outlive this.
  LitScene(const gpu::Device& device, const Scene& scene, int width, int height);  // pixels

  const SceneBuffers& buffers() const { return buffers_; }
  const LightModel& light() const { return light_; }
  // For a map that encloses the whole scene, whatever the camera sees; `side` in texels.
  FitInput fitInput(int side) const;

  // What the camera sees, and how a map that is drawn by then lights it through a filter (kShadowFilter*).
  void record(gpu::Commands& commands, const MapImage& map, const BiasMethod& bias, int filter);
  // The same where something else than a map writes the visibility: `light` records that.
  using Light = std::function<void(VisibilityPass& into, const GBuffer& seen)>;
  void record(gpu::Commands& commands, const glsl::BiasParams& params, const Light& light);
  // Linear rgb, after the commands are done.
  ImageF picture() const;

 private:
  const gpu::Device& device_;
  const Scene& scene_;
  SceneBuffers buffers_;
  glsl::CameraView camera_;
  LightModel light_;
  glm::vec3 lightColor_;  // so that a white surface as far from the light as the camera has half of it
  GBuffer gbuffer_;
  VisibilityPass visibility_;
  RadiancePass radiance_;
};

}  // namespace gnomon
