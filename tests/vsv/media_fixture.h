#pragma once
// Scenes in fog: volume and maps of a light, fitted to all view rays, and what MediaPass makes of them.

#include "scene/generate.h"
#include "tests/gpu_fixture.h"
#include "vsv/media/density.h"
#include "vsv/media/media_pass.h"
#include "vsv/media/media_receivers.h"
#include "vsv/shadow_volume.h"
#include "vsv/volume_parameterization.h"

#include <memory>
#include <optional>

namespace gnomon::test {

struct MediaSetup {
  Scene scene;
  Camera camera;
  MediaLightSource light;
  glsl::Medium medium = {};  // reach 0: to the farthest corner
  VolumeSize size = {.alpha = 512, .theta = 512, .phi = 256};
  VolumeSource source = VolumeSource::Direct;
  VolumeFit fit = VolumeFit::Frustum;
  int mapSide = 512;  // of a cube's face
  int pictureSide = 128;
  std::string density;  // FILE.vdb; empty: homogeneous
};
// A generated scene with its first point light and camera.
MediaSetup mediaSetup(const char* scene);
// Nothing but a small triangle far behind the camera: the light is hidden nowhere.
MediaSetup emptyMediaSetup(const glm::vec3& eyeW, const glm::vec3& targetW, const glm::dvec3& lightW);

class MediaWorld {
 public:
  MediaWorld(const gpu::Device& device, const MediaSetup& setup);

  // From now on nothing is in the light's way, as far as volume and maps know.
  void removeShadows();

  // In-scattered light, a vec3 a pixel.
  std::vector<glm::vec3> scattered(const MediaMethod& method, bool paraboloid = false);

  MediaSetup setup;
  SceneBuffers buffers;
  glsl::CameraView view;
  GBuffer gbuffer;
  Receivers receivers;
  std::vector<glm::dvec3> endsW;  // of the view rays, a pixel each, and the eye
  std::unique_ptr<ShadowVolume> volume;
  std::unique_ptr<MapImage> cube, paraboloid;
  std::unique_ptr<DensityGrid> density;
  std::unique_ptr<DensityBuffers> densityBuffers;
  MediaPass pass;

 private:
  const gpu::Device& device_;
  FittedMap fittedCube_, fittedParaboloid_;
};

// L(x) of shaders/shared/medium.glsl without occluders, by adaptive quadrature over metres in double;
// `begin`: only from there on, metres from the eye.
glm::dvec3 unshadowedLight(const glsl::Medium& medium, const MediaLightSource& light, const glm::dvec3& eyeW,
                           const glm::dvec3& endW, double begin = 0.0);

// sqrt of the mean square difference over the mean of `expected`, of all channels.
double relativeRmse(const std::vector<glm::vec3>& measured, const std::vector<glm::vec3>& expected);

}  // namespace gnomon::test
