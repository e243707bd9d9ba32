// A point light with a dual-paraboloid map of the same number of texels as the cube of 01: two layers instead
// of six. The bias of Weiskopf & Ertl takes half of what lies between the two nearest depths.
//
//   02_point_light_paraboloid [SCENE [OUT.png]]      SCENE: a glTF file or the name of a generated scene

#include "base/image.h"
#include "judge/lit_scene.h"
#include "omni/paraboloid_map.h"
#include "scene/generate.h"

#include <cstdio>
#include <exception>

using namespace gnomon;

namespace {

constexpr int kSide = 512;     // pixels of the picture
constexpr int kMapSide = 887;  // texels of a hemisphere: 2 * 887^2 = 6 * 512^2

void run(const char* sceneName, const char* path) {
  const Scene scene = openScene(sceneName);
  const auto device = gpu::Device::create({});
  LitScene lit(*device, scene, kSide, kSide);

  // bias.channels: the map holds both layers of depth.
  const BiasMethod& bias = findBias("dual");
  MapImage map(*device, paraboloidParameterization().fit(lit.fitInput(kMapSide)), bias.channels);
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
    run(argc > 1 ? argv[1] : "atrium", argc > 2 ? argv[2] : "point_light_paraboloid.png");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
