#pragma once
// Shadow volumes of generated scenes, drawn for a camera, a light and a fit, and what the truth says of them.

#include "tests/judge/lit_map.h"
#include "vsv/volume_parameterization.h"

#include <optional>
#include <random>

namespace gnomon::test {

struct VolumeSetup {
  const char* scene = "tilted-planes";
  std::optional<glm::dvec3> lightW;  // absent: the scene's first light
  std::optional<Camera> camera;      // absent: the scene's first
  VolumeSize size = {.alpha = 512, .theta = 512, .phi = 256};
  VolumeSource source = VolumeSource::Direct;
  VolumeFit fit = VolumeFit::Frustum;
  int cubeSide = 512;
  int pictureSide = 256;
};

// A scene with its volume built; nothing is culled. Stays where it is made.
struct VolumeWorld {
  SceneView seen;
  ShadowPasses passes;
  LightOnMap lit;
  const ShadowVolume& volume;

  VolumeWorld(const gpu::Device& device, const VolumeSetup& setup);
  VolumeWorld(const VolumeWorld&) = delete;
  VolumeWorld& operator=(const VolumeWorld&) = delete;

  LabelledResult judge(const char* bias) { return lit.judge(atDefaults(findBias(bias), seen)); }
};

// A grid as fitVolume makes them, with the light at the origin and the eye at distance D along z.
FittedMap columnsFor(double eyeDistance, const VolumeSize& size, VolumeFit fit, const Camera& camera);

}  // namespace gnomon::test
