#pragma once
// A generated scene by its first camera, and one of its lights on a map.

#include "judge/light_on_map.h"
#include "scene/generate.h"
#include "tests/gpu_fixture.h"

#include <string>

namespace gnomon::test {

// A fixture's device, which outlives what it is lent to.
inline std::shared_ptr<const gpu::Device> lent(const gpu::Device& device) {
  return {std::shared_ptr<const gpu::Device>(), &device};
}

// Stays where it is made: the light holds on to what stands before it.
struct LitMap {
  SceneView seen;
  ShadowPasses passes;
  LightOnMap lit;

  LitMap(const gpu::Device& device, const std::string& scene, const Parameterization& map, int pictureSide,
         MapSetup setup)
      : seen(lent(device), openScene(scene), pictureSide, pictureSide),
        passes(seen),
        lit(seen, passes, map, std::move(setup)) {}
  LitMap(const LitMap&) = delete;
  LitMap& operator=(const LitMap&) = delete;

  LabelledResult judge(const BiasMethod& bias) { return lit.judge(atDefaults(bias, seen)); }
  LabelledResult judge(const char* bias) { return judge(findBias(bias)); }
};

}  // namespace gnomon::test
