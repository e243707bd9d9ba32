// A point light with a dual-paraboloid map of the same number of texels as the cube of 01: two layers instead of six.
// The bias of Weiskopf & Ertl takes half of what lies between the two nearest depths.
//
//   02_point_light_paraboloid [SCENE [OUT.png]]      SCENE: a glTF file or the name of a generated scene

#include "base/image.h"
#include "judge/light_on_map.h"
#include "omni/paraboloid_map.h"
#include "scene/generate.h"

#include <cstdio>
#include <exception>

using namespace gnomon;

namespace {

constexpr int kSide = 512;     // pixels of the picture
constexpr int kMapSide = 887;  // texels of a hemisphere: 2 * 887^2 = 6 * 512^2

void run(const char* sceneName, const char* path) {
  const SceneView seen(gpu::Device::create({}), openScene(sceneName), kSide, kSide);
  ShadowPasses passes(seen);

  // The hemispheres enclose the whole scene (no receivers), whatever the camera sees.
  LightOnMap lit(seen, passes, paraboloidParameterization(),
                 {.side = kMapSide, .receiversW = std::vector<glm::dvec3>()});
  // What a bias reads of a map is drawn when it is asked for: this one reads two depths.
  const Method dual = atDefaults(findBias("dual"), seen);
  const std::vector<float> visibility = lit.visibility(dual, glsl::kShadowFilterBilinear);

  // So that a white surface as far from the light as the camera has radiance 0.5.
  const float distance = glm::distance(seen.view().eyeW, glm::vec3(lit.light().positionW));
  const Exposure exposure{.lightColor = lit.source().color * (0.5f * distance * distance), .ambient = glm::vec3(0.05f)};
  writePng(path, toSrgb8(lit.radiance(visibility, exposure)));
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
