// A lamp behind bars in fog: the light's visibility in the whole view volume is voxelized into bits, one a place along
// a light ray, and each pixel sums the runs of lit bits along its view ray. Light shafts without marching.
//
//   04_lamp_in_fog [SCENE [OUT.png]]      SCENE: a glTF file or the name of a generated scene

#include "base/image.h"
#include "judge/light_on_map.h"
#include "scene/generate.h"
#include "vsv/media/media_pass.h"
#include "vsv/media/media_receivers.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <cstdio>
#include <exception>

using namespace gnomon;

namespace {

constexpr int kSide = 512;             // pixels
constexpr float kOpticalDepth = 2.5f;  // of the fog across the scene

void run(const char* sceneName, const char* path) {
  const SceneView seen(gpu::Device::create({}), openScene(sceneName), kSide, kSide);
  const Light& source = seen.scene().lights.at(0);
  const MediaLightSource lamp = mediaLight(source);
  const glm::vec3 sigmaS(kOpticalDepth / seen.sceneScale());  // 1/m
  const glsl::Medium fog{
      .sigmaS = sigmaS, .sigmaA = {}, .g = 0.3f, .reach = defaultReach(seen.scene(), seen.view().eyeW)};

  // The volume is fitted to where the view rays end.
  const Receivers surfaces = computeReceivers(seen.tracer(), seen.view(), {}, seen.primitiveIds());
  ShadowPasses passes(seen);
  LightOnMap lit(seen, passes, volumeParameterization(), source,
                 {.receiversW = mediaReceiversW(seen.view(), surfaces, fog.reach)});
  const Occluders& volume = lit.occluders();

  const Method adaptive = atDefaults(findBias("adaptive"), seen);
  glsl::ShadeUniforms shade = shadeUniforms(seen.view(), lit.light(), adaptive.params);
  shade.lightColor = lamp.intensity / glsl::kPi;
  VisibilityPass& visibility = passes.visibility;
  visibility.setUniforms(shade);
  MediaPass media(seen.device(), kSide, kSide);
  media.setMedium(seen.view(), fog);

  gpu::Commands commands(seen.device(), "frame");
  media.recordTable(commands, volume, lamp);
  volume.recordVisibility(commands, seen.buffers(), seen.gbuffer(), visibility, {.bias = *adaptive.bias});
  commands.barrier("visibility and the running integral are written -> surfaces and view rays read them");
  media.recordSurfaces(commands, seen.buffers(), seen.gbuffer(), lamp, visibility.uniforms(), visibility.visibility(),
                       false);
  media.record(commands, seen.buffers(), seen.gbuffer(), volume, lamp, mediaMethod("runs"), false);
  commands.barrier("surfaces and scattered light are written -> their sum reads them");
  media.recordSum(commands);
  commands.submitAndWait();

  ImageF picture(kSide, kSide, 3);
  picture.values = gpu::downloadAs<float>(seen.device(), media.radiance());
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
