#pragma once
// Shadow volumes of generated scenes, drawn for a camera, a light and a fit, and what the truth says of them.

#include "scene/generate.h"
#include "tests/gpu_fixture.h"
#include "truth/labels.h"
#include "vsv/volume_parameterization.h"
#include "vsv/volume_renderer.h"
#include "vsv/volume_visibility.h"

#include <memory>
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

// A scene with its volume built.
struct VolumeWorld {
  Scene scene;
  std::unique_ptr<Tracer> tracer;
  SceneBuffers buffers;
  glsl::CameraView view;
  std::unique_ptr<GBuffer> gbuffer;
  LightModel light;
  Receivers receivers;
  FittedMap columns;
  std::unique_ptr<ShadowVolume> volume;
};
VolumeWorld buildVolume(const gpu::Device& device, const VolumeSetup& setup);

struct VolumeScore {
  LabelImage labels;
  std::vector<float> visibility;
  std::vector<glsl::PixelDiagnosis> diagnosis;
};
VolumeScore scoreVolume(const gpu::Device& device, const VolumeWorld& world, const char* bias);

// A grid as fitVolume makes them, with the light at the origin and the eye at distance D along z.
FittedMap columnsFor(double eyeDistance, const VolumeSize& size, VolumeFit fit, const Camera& camera);

}  // namespace gnomon::test
