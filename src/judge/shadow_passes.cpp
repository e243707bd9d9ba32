#include "judge/shadow_passes.h"

namespace gnomon {

ShadowPasses::ShadowPasses(const gpu::Device& device, int width, int height)
    : maps(device),
      visibility(device, width, height),
      decisions(device, width, height),
      radiance(device, width, height),
      frame(device, width, height) {}

ShadowPasses::ShadowPasses(const SceneView& view)
    : ShadowPasses(view.device(), view.view().width, view.view().height) {}

ImageF ShadowPasses::shade(const SceneView& view, const glsl::ShadeUniforms& uniforms, std::span<const float> values) {
  visibility.setUniforms(uniforms);
  gpu::upload(view.device(), visibility.visibility(), std::as_bytes(values));
  timeShading(view);
  ImageF image(view.view().width, view.view().height, 3);
  image.values = gpu::downloadAs<float>(view.device(), radiance.radiance());
  return image;
}

double ShadowPasses::timeShading(const SceneView& view) {
  gpu::Commands commands(view.device(), "radiance");
  radiance.record(commands, view.buffers(), view.gbuffer(), visibility.uniforms(), visibility.visibility());
  return commands.submitAndWait().wallMs;
}

}  // namespace gnomon
