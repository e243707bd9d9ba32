// A point light with a voxelized shadow volume: one bit a voxel for all of what the camera can see, here
// looked up at its surfaces by the adjacent-voxel rule (Dou et al. 2014, section 3.3).
//
//   03_shadow_volume [SCENE [OUT.png]]      SCENE: a glTF file or the name of a generated scene

#include "base/image.h"
#include "judge/lit_scene.h"
#include "scene/generate.h"
#include "vsv/shadow_volume.h"
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
  LitScene lit(*device, scene, kSide, kSide);

  // The grid of columns, each a light ray, and the map of their nearest occluders; the bits come of those.
  ShadowVolume volume(*device, fitVolume(lit.fitInput(kSide), kSize, VolumeFit::Frustum));
  const MapRenderer maps(*device);
  const VolumeRenderer volumes(*device);
  VolumeVisibility lookUp(*device);

  gpu::Commands commands(*device, "frame");
  volumes.record(commands, maps, lit.buffers(), volume, lit.light(), CullMode::Solids);
  const BiasMethod& bias = findBias("adaptive");
  const glsl::BiasParams params = defaultBiasParams(bias, computeBounds(scene).diagonal());
  lit.record(commands, params, [&](VisibilityPass& into, const GBuffer& seen) {
    lookUp.record(commands, lit.buffers(), seen, volume, into, bias, false);
  });
  commands.submitAndWait();

  writePng(path, toSrgb8(lit.picture()));
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
