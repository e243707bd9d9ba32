#pragma once
// The passes that render occluders and light pictures of one size. All lights, maps and cameras of a device share them,
// one after another.

#include "base/image.h"
#include "judge/scene_view.h"
#include "shadow/decision_pass.h"
#include "shadow/frame_pass.h"
#include "shadow/visibility_pass.h"

namespace gnomon {

struct ShadowPasses {
  MapRenderer maps;
  VisibilityPass visibility;
  DecisionPass decisions;  // instead of it, where several methods of one map are judged
  RadiancePass radiance;
  FramePass frame;  // instead of the two before it, where one method is asked for

  ShadowPasses(const gpu::Device& device, int width, int height);  // pixels
  explicit ShadowPasses(const SceneView& view);

  // Linear rgb of the view's surfaces, by one visibility a pixel.
  ImageF shade(const SceneView& view, const glsl::ShadeUniforms& uniforms, std::span<const float> values);
  // Wall clock of shading once more, by what the passes hold; milliseconds.
  double timeShading(const SceneView& view);
};

}  // namespace gnomon
