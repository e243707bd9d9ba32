// A point light with a voxelized shadow volume: one bit a voxel for all of what the camera can see, here
// looked up at its surfaces by the adjacent-voxel rule (Dou et al. 2014, section 3.3).
//
//   03_shadow_volume [SCENE [OUT.png]]      SCENE: a glTF file or the name of a generated scene

#include "base/image.h"
#include "scene/generate.h"
#include "vsv/volume_parameterization.h"
#include "vsv/volume_renderer.h"
#include "vsv/volume_visibility.h"

#include <cstdio>
#include <exception>

using namespace gnomon;

namespace {

constexpr int kSide = 512;                                           // pixels of the picture
constexpr VolumeSize kSize{.alpha = 512, .theta = 512, .phi = 256};  // voxels

void run(const char* sceneName, const char* path) {
  const Scene scene = openScene(sceneName);
  const auto device = gpu::Device::create({});
  const SceneBuffers buffers = createSceneBuffers(*device, scene);
  const glsl::CameraView camera = cameraView(scene.cameras.at(0), kSide, kSide);
  const LightModel light{.type = LightType::Point, .positionW = glm::dvec3(scene.lights.at(0).positionW)};

  // The grid of columns, each a light ray, and the map of their nearest occluders; the bits come of those.
  const FittedVolume fitted = fitVolume({.scene = scene, .light = light, .receiversW = {}, .camera = camera},
                                        kSize, VolumeFit::Frustum);
  ShadowVolume volume(*device, fitted);

  const GBuffer gbuffer(*device, kSide, kSide);
  const MapRenderer maps(*device);
  const VolumeRenderer volumes(*device);
  VisibilityPass visibility(*device, kSide, kSide);
  VolumeVisibility lookUp(*device);
  const RadiancePass radiance(*device, kSide, kSide);
  glsl::ShadeUniforms shade = shadeUniforms(camera, light, defaultBiasParams(fitted.columns.map.sceneScale));
  const float distance = glm::distance(camera.eyeW, glm::vec3(light.positionW));
  shade.lightColor = scene.lights.at(0).color * (0.5f * distance * distance);
  shade.ambient = glm::vec3(0.05f);
  visibility.setUniforms(shade);

  gpu::Commands commands(*device, "frame");
  gbuffer.record(commands, buffers, camera);
  volumes.record(commands, maps, buffers, volume, light, CullMode::Solids);
  commands.barrier("G-buffer and shadow volume are written -> the visibility pass fetches them");
  lookUp.record(commands, buffers, gbuffer, volume, visibility, findBias("adaptive"), false);
  commands.barrier("visibility is written -> the radiance pass reads it");
  radiance.record(commands, buffers, gbuffer, visibility.uniforms(), visibility.visibility());
  commands.submitAndWait();

  ImageF picture(kSide, kSide, 3);
  picture.values = gpu::downloadAs<float>(*device, radiance.radiance());
  writePng(path, toSrgb8(picture));
  std::printf("wrote %s\n", path);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc > 1 ? argv[1] : "atrium", argc > 2 ? argv[2] : "shadow_volume.png");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
