// A point light with a voxelized shadow volume: one bit a voxel for all of what the camera can see, here looked up at
// its surfaces by the adjacent-voxel rule (Dou et al. 2014, section 3.3).
//
//   03_shadow_volume [SCENE [OUT.png]]      SCENE: a glTF file or the name of a generated scene

#include "base/image.h"
#include "judge/light_on_map.h"
#include "scene/generate.h"
#include "vsv/volume_parameterization.h"

#include <cstdio>
#include <exception>

using namespace gnomon;

namespace {

constexpr int kSide = 512;                                           // pixels of the picture
constexpr VolumeSize kSize{.alpha = 512, .theta = 512, .phi = 256};  // voxels

void run(const char* sceneName, const char* path) {
  const SceneView seen(gpu::Device::create({}), openScene(sceneName), kSide, kSide);
  ShadowPasses passes(seen);

  // A grid of columns, each a light ray; the nearest occluder in each; and the bits that follow from those.
  LightOnMap lit(seen, passes, volumeParameterization(),
                 {.options = {kVolumeSize(kSize)}, .receiversW = std::vector<glm::dvec3>()});
  const std::vector<float> visibility = lit.visibility(atDefaults(findBias("adaptive"), seen));

  // So that a white surface as far from the light as the camera has radiance 0.5.
  const float distance = glm::distance(seen.view().eyeW, glm::vec3(lit.light().positionW));
  const Exposure exposure{.lightColor = lit.source().color * (0.5f * distance * distance), .ambient = glm::vec3(0.05f)};
  writePng(path, toSrgb8(lit.radiance(visibility, exposure)));
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
