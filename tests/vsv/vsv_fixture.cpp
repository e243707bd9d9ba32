#include "vsv_fixture.h"

namespace gnomon::test {

namespace {

SceneView viewOf(const gpu::Device& device, const VolumeSetup& setup) {
  auto traced = std::make_shared<const TracedScene>(openScene(setup.scene));
  const Camera camera = setup.camera ? *setup.camera : traced->scene.cameras.front();
  return {lent(device), std::move(traced), camera, setup.pictureSide, setup.pictureSide};
}

Light lightOf(const Scene& scene, const VolumeSetup& setup) {
  Light light = *firstLightFor(scene, volumeParameterization());
  if (setup.lightW) light.positionW = glm::vec3(*setup.lightW);
  return light;
}

}  // namespace

VolumeWorld::VolumeWorld(const gpu::Device& device, const VolumeSetup& setup)
    : seen(viewOf(device, setup)),
      passes(seen),
      lit(seen, passes, volumeParameterization(), lightOf(seen.scene(), setup),
          {.side = setup.cubeSide,
           .options = {kVolumeSize(setup.size), kVolumeSource(setup.source), kVolumeFit(setup.fit)},
           .cull = CullMode::None}),
      volume(asVolume(lit.occluders())) {}

FittedMap columnsFor(double eyeDistance, const VolumeSize& size, VolumeFit fit, const Camera& camera) {
  Scene scene;
  scene.meshes.push_back({.positions = {{-50, -50, -50}, {50, 50, 50}, {50, -50, 50}}, .indices = {0, 1, 2}});
  scene.instances.push_back({});
  Camera placed = camera;
  placed.worldFromEye[3] = glm::vec4(0.0f, 0.0f, static_cast<float>(eyeDistance), 1.0f);
  const LightModel light{.type = LightType::Point};
  const glsl::CameraView view = cameraView(placed, 64, 48);
  return fitVolume({.scene = scene, .light = light, .receiversW = {}, .camera = view}, size, fit);
}

}  // namespace gnomon::test
