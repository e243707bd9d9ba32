// The instrument's own error on scenes that people made: pixels whose truth hangs on the end margin.

#include "shot.h"

#include "scene/gltf.h"

#include "tests/base/places.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

namespace gnomon::test {
namespace {

glsl::CameraView cameraOf(const Scene& scene, int size) {
  const Bounds bounds = computeBounds(scene);
  const glm::dvec3 center(bounds.center());
  const glm::dvec3 extent(bounds.upper - bounds.lower);
  if (scene.cameras.empty()) return viewFrom(center + 0.3 * extent, center - 0.1 * extent, 1.2, size, size);
  const glm::mat4& worldFromEye = scene.cameras[0].worldFromEye;
  const glm::dvec3 eye{glm::vec3(worldFromEye[3])};
  return viewFrom(eye, eye - glm::dvec3(glm::vec3(worldFromEye[2])), scene.cameras[0].yFovRad, size, size);
}

std::vector<LightModel> lightsOf(const Scene& scene) {
  std::vector<LightModel> lights;
  for (const Light& light : scene.lights) {
    if (light.type != LightType::Directional) lights.push_back(pointLight(glm::dvec3(light.positionW)));
  }
  if (lights.size() > 4) lights.resize(4);
  if (lights.empty()) {
    const Bounds bounds = computeBounds(scene);
    lights.push_back(
        pointLight(glm::dvec3(bounds.center()) + glm::dvec3(0.1, 0.4, 0.2) * glm::dvec3(bounds.upper - bounds.lower)));
  }
  return lights;
}

class RealScene : public testing::TestWithParam<const char*> {};

TEST_P(RealScene, HangsOnTheMarginAtFewerThanOnePixelInTenThousand) {
  const std::filesystem::path path = std::filesystem::path(test::inSource("../shared/scenes")) / GetParam();
  if (!std::filesystem::is_directory(test::inSource("../shared/scenes")))
    GTEST_SKIP() << "skipped: ../shared/scenes is not here";
  const Scene scene = loadGltf(path);
  const Tracer tracer(scene);
  const glsl::CameraView camera = cameraOf(scene, 512);
  const std::vector<glsl::PrimitiveId> ids = traceIds(tracer, camera);
  size_t scored = 0, flips = 0;
  for (const LightModel& light : lightsOf(scene)) {
    const Receivers receivers = computeReceivers(tracer, camera, light, ids);
    const Truth truth = computeTruth(tracer, light, receivers);
    scored += receivers.scored;
    flips += std::max(truth.marginFlipsHalf, truth.marginFlipsDouble);
  }
  EXPECT_GT(scored, 1000u);
  EXPECT_LT(static_cast<double>(flips), 1e-4 * static_cast<double>(scored));
}

INSTANTIATE_TEST_SUITE_P(Shared, RealScene,
                         testing::Values("level_rpg3dm2.glb", "level_dm6.glb", "chinesedragon.gltf",
                                         "shadowscene_fire.gltf", "godrays_pointlight.glb"));

}  // namespace
}  // namespace gnomon::test
