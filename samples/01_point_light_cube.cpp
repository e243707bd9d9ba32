// A point light with a cube map: scene, camera, map, visibility, picture.
//
//   01_point_light_cube [SCENE [OUT.png]]      SCENE: a glTF file or the name of a generated scene

#include "base/image.h"
#include "omni/cube_map.h"
#include "scene/generate.h"
#include "shadow/visibility_pass.h"

#include <cstdio>
#include <exception>

using namespace gnomon;

namespace {

constexpr int kSide = 512;     // pixels of the picture
constexpr int kMapSide = 512;  // texels of a face

void run(const char* sceneName, const char* path) {
  const Scene scene = openScene(sceneName);
  const auto device = gpu::Device::create({});
  const SceneBuffers buffers = createSceneBuffers(*device, scene);
  const glsl::CameraView camera = cameraView(scene.cameras.at(0), kSide, kSide);
  const LightModel light{.type = LightType::Point, .positionW = glm::dvec3(scene.lights.at(0).positionW)};

  // Without receivers the map encloses the whole scene.
  const FittedMap fitted = cubeParameterization().fit(
      {.scene = scene, .light = light, .receiversW = {}, .side = kMapSide, .camera = camera});
  const BiasMethod& bias = findBias("adaptive");
  MapImage map(*device, fitted, bias.content);

  const GBuffer gbuffer(*device, kSide, kSide);
  const MapRenderer maps(*device);
  VisibilityPass visibility(*device, kSide, kSide);
  const RadiancePass radiance(*device, kSide, kSide);
  glsl::ShadeUniforms shade = shadeUniforms(camera, light, defaultBiasParams(fitted.map.sceneScale));
  const float distance = glm::distance(camera.eyeW, glm::vec3(light.positionW));
  shade.lightColor = scene.lights.at(0).color * (0.5f * distance * distance);
  shade.ambient = glm::vec3(0.05f);
  visibility.setUniforms(shade);

  gpu::Commands commands(*device, "frame");
  gbuffer.record(commands, buffers, camera);
  maps.record(commands, buffers, map, light, CullMode::Solids);
  commands.barrier("G-buffer and shadow map are written -> the visibility pass fetches them");
  visibility.record(commands, buffers, gbuffer, map, bias, false, glsl::kFilterBilinear);
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
    run(argc > 1 ? argv[1] : "atrium", argc > 2 ? argv[2] : "point_light_cube.png");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
