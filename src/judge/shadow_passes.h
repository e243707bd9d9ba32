#pragma once
// What draws occluders and lights pictures of one size: shared, one after another, by all lights, maps and cameras of a
// device.

#include "base/image.h"
#include "judge/scene_view.h"
#include "shadow/visibility_pass.h"

namespace gnomon {

struct ShadowPasses {
  MapRenderer maps;
  VisibilityPass visibility;
  RadiancePass radiance;

  ShadowPasses(const gpu::Device& device, int width, int height);  // pixels
  explicit ShadowPasses(const SceneView& view);

  // Linear rgb of the view's surfaces, by one visibility a pixel.
  ImageF shade(const SceneView& view, const glsl::ShadeUniforms& uniforms, std::span<const float> values);
  // Wall clock of shading once more, by what the passes hold; milliseconds.
  double timeShading(const SceneView& view);
};

}  // namespace gnomon
