#include "judge/lit_scene.h"

#include "base/error.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

const Camera& firstCamera(const Scene& scene) {
  if (scene.cameras.empty()) throw WorldError(fmt::format("scene '{}' has no camera", scene.name));
  return scene.cameras.front();
}

const Light& firstPositionalLight(const Scene& scene) {
  const auto found =
      std::ranges::find_if(scene.lights, [](const Light& light) { return light.type != LightType::Directional; });
  if (found == scene.lights.end()) throw WorldError(fmt::format("scene '{}' has no light with a place", scene.name));
  return *found;
}

}  // namespace

LitScene::LitScene(const gpu::Device& device, const Scene& scene, int width, int height)
    : device_(device),
      scene_(scene),
      buffers_(createSceneBuffers(device, scene)),
      camera_(cameraView(firstCamera(scene), width, height)),
      light_{.type = LightType::Point, .positionW = glm::dvec3(firstPositionalLight(scene).positionW)},
      gbuffer_(device, width, height),
      visibility_(device, width, height),
      radiance_(device, width, height) {
  const float distance = glm::distance(camera_.eyeW, glm::vec3(light_.positionW));
  lightColor_ = firstPositionalLight(scene).color * (0.5f * distance * distance);
}

FitInput LitScene::fitInput(int side) const {
  return {.scene = scene_, .light = light_, .receiversW = {}, .side = side, .camera = camera_};
}

void LitScene::record(gpu::Commands& commands, const MapImage& map, const BiasMethod& bias, int filter) {
  const glsl::BiasParams params = defaultBiasParams(bias, computeBounds(scene_).diagonal());
  record(commands, params, [&](VisibilityPass& into, const GBuffer& seen) {
    into.record(commands, buffers_, seen, map, bias, false, filter);
  });
}

void LitScene::record(gpu::Commands& commands, const glsl::BiasParams& params, const Light& light) {
  glsl::ShadeUniforms shade = shadeUniforms(camera_, light_, params);
  shade.lightColor = lightColor_;
  shade.ambient = glm::vec3(0.05f);
  visibility_.setUniforms(shade);
  gbuffer_.record(commands, buffers_, camera_);
  commands.barrier("G-buffer and shadow map are written -> the visibility pass fetches them");
  light(visibility_, gbuffer_);
  commands.barrier("visibility is written -> the radiance pass reads it");
  radiance_.record(commands, buffers_, gbuffer_, visibility_.uniforms(), visibility_.visibility());
}

ImageF LitScene::picture() const {
  ImageF picture(camera_.width, camera_.height, 3);
  picture.values = gpu::downloadAs<float>(device_, radiance_.radiance());
  return picture;
}

}  // namespace gnomon
