// A point light with a cube map: the scene's first light, six faces around it, the adaptive bias of Dou et
// al.
//
//   01_point_light_cube [SCENE [OUT.png]]      SCENE: a glTF file or the name of a generated scene

#include "base/image.h"
#include "judge/lit_scene.h"
#include "omni/cube_map.h"
#include "scene/generate.h"

#include <cstdio>
#include <exception>

using namespace gnomon;

namespace {

constexpr int kSide = 512;     // pixels of the picture
constexpr int kMapSide = 512;  // texels of a face

void run(const char* sceneName, const char* path) {
  const Scene scene = openScene(sceneName);
  const auto device = gpu::Device::create({});
  LitScene lit(*device, scene, kSide, kSide);

  // A bias says what it reads of a map: this one a single layer of depth.
  const BiasMethod& bias = findBias("adaptive");
  MapImage map(*device, cubeParameterization().fit(lit.fitInput(kMapSide)), bias.channels);
  const MapRenderer renderer(*device);

  gpu::Commands commands(*device, "frame");
  renderer.record(commands, lit.buffers(), map, lit.light(), CullMode::Solids);
  lit.record(commands, map, bias, glsl::kShadowFilterBilinear);
  commands.submitAndWait();

  writePng(path, toSrgb8(lit.picture()));
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
