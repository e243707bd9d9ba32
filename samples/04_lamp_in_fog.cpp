// A lamp behind bars in fog: the light's visibility in the whole view volume is voxelized into bits, one a
// place along a light ray, and each pixel sums the runs of lit bits along its view ray. Light shafts without
// marching.
//
//   04_lamp_in_fog [SCENE [OUT.png]]      SCENE: a glTF file or the name of a generated scene

#include "base/image.h"
#include "scene/generate.h"
#include "shadow/visibility_pass.h"
#include "vsv/media/media_pass.h"
#include "vsv/volume_renderer.h"
#include "vsv/volume_visibility.h"

#include <algorithm>
#include <cstdio>
#include <exception>

using namespace gnomon;

namespace {

constexpr int kSide = 512;             // pixels
constexpr float kOpticalDepth = 2.5f;  // of the fog across the scene

void run(const char* sceneName, const char* path) {
  const Scene scene = openScene(sceneName);
  const auto device = gpu::Device::create({});
  const SceneBuffers buffers = createSceneBuffers(*device, scene);
  const glsl::CameraView camera = cameraView(scene.cameras.at(0), kSide, kSide);
  const MediaLightSource lamp = mediaLight(scene.lights.at(0));
  const LightModel light{.type = LightType::Point, .positionW = lamp.positionW};
  const glm::vec3 sigmaS(kOpticalDepth / computeBounds(scene).diagonal());  // 1/m
  const glsl::Medium fog{.sigmaS = sigmaS, .sigmaA = {}, .g = 0.3f, .reach = defaultReach(scene, camera.eyeW)};

  // The volume is fitted to where the view rays end, which takes a first look at the scene.
  const GBuffer gbuffer(*device, kSide, kSide);
  gpu::Commands look(*device, "look");
  gbuffer.record(look, buffers, camera);
  look.submitAndWait();
  const Receivers receivers =
      computeReceivers(Tracer(scene), camera, light, downloadPrimitiveIds(*device, gbuffer, buffers));
  const std::vector<glm::dvec3> ends = mediaReceiversW(camera, receivers, fog.reach);
  const FittedVolume fitted = fitVolume({.scene = scene, .light = light, .receiversW = ends, .camera = camera},
                                        VolumeSize{}, VolumeFit::Frustum);
  ShadowVolume volume(*device, fitted);

  const MapRenderer maps(*device);
  const VolumeRenderer volumes(*device);
  VisibilityPass visibility(*device, kSide, kSide);
  VolumeVisibility lookUp(*device);
  MediaPass media(*device, kSide, kSide);
  const BiasMethod& bias = findBias("adaptive");
  glsl::ShadeUniforms shade = shadeUniforms(camera, light, defaultBiasParams(bias, fitted.columns.map.sceneScale));
  shade.lightColor = lamp.intensity / glsl::kPi;
  visibility.setUniforms(shade);
  media.setMedium(camera, fog);

  gpu::Commands commands(*device, "frame");
  volumes.record(commands, maps, buffers, volume, light, CullMode::Solids);
  media.recordTable(commands, volume, lamp);
  lookUp.record(commands, buffers, gbuffer, volume, visibility, bias, false);
  commands.barrier("visibility and the running integral are written -> surfaces and view rays read them");
  media.recordSurfaces(commands, buffers, gbuffer, lamp, visibility.uniforms(), visibility.visibility(), false);
  media.record(commands, buffers, gbuffer, volume, lamp, {.integrator = Integrator::Runs}, false);
  commands.barrier("surfaces and scattered light are written -> their sum reads them");
  media.recordSum(commands);
  commands.submitAndWait();

  ImageF picture(kSide, kSide, 3);
  picture.values = gpu::downloadAs<float>(*device, media.radiance());
  // Exposed so that three pixels in a hundred are white.
  std::vector<float> sorted = picture.values;
  const auto bright = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 97 / 100);
  std::ranges::nth_element(sorted, bright);
  for (float& value : picture.values) value /= *bright;
  writePng(path, toSrgb8(picture));
  std::printf("wrote %s\n", path);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc > 1 ? argv[1] : "grate", argc > 2 ? argv[2] : "lamp_in_fog.png");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
