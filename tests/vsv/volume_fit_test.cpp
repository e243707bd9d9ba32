// fitVolume: what the camera sees is covered, and little more, wherever the light is.
#include "base/error.h"
#include "vsv/volume_parameterization.h"
#include "vsv_fixture.h"

#include "shared/volume_lookup.glsl"

#include <cmath>
#include <numbers>

namespace gnomon {
namespace {

constexpr double kPi = std::numbers::pi;

struct Fitted {
  Scene scene;
  LightModel light;
  glsl::CameraView view;
  std::vector<glm::dvec3> receivers;
  FittedMap columns;
};

Scene boxOf(float half) {
  Scene scene;
  scene.meshes.push_back(
      {.positions = {{-half, -half, -half}, {half, half, half}, {half, -half, half}}, .indices = {0, 1, 2}});
  scene.instances.push_back({});
  return scene;
}

// What the picture shows: through the pixels' centres and its corners, at random distances.
Fitted fitFor(const glm::dvec3& lightW, const Camera& camera, VolumeFit fit, std::mt19937& random) {
  Fitted f{.scene = boxOf(10.0f), .light = {.positionW = lightW}, .view = cameraView(camera, 40, 30)};
  std::uniform_real_distribution<double> distances(0.2, 12.0);
  const glm::dvec3 eye(f.view.eyeW), right(f.view.rightW), up(f.view.upW), forward(f.view.forwardW);
  for (int y = 0; y <= 30; ++y)
    for (int x = 0; x <= 40; ++x)
      f.receivers.push_back(eye + distances(random) * (forward + right * ((x / 20.0 - 1.0) * f.view.tanHalfX) +
                                                       up * ((y / 15.0 - 1.0) * f.view.tanHalfY)));
  f.columns = fitVolume({.scene = f.scene, .light = f.light, .receiversW = f.receivers, .camera = f.view},
                        {.alpha = 128, .theta = 96, .phi = 128}, fit);
  return f;
}

void expectCovered(const Fitted& f) {
  const glsl::ShadowMap& map = f.columns.map;
  const glsl::EpipolarGrid& grid = f.columns.map.epipolar;
  for (const glm::dvec3& receiver : f.receivers) {
    const glm::vec3 posL = glsl::lightFromWorld(f.columns.frame, glm::vec3(receiver));
    ASSERT_TRUE(glsl::mapProject(map, posL).covered);
    const float alpha = glsl::epipolarFromLight(grid.eyeDistance, posL).alpha;
    ASSERT_GE(alpha, grid.alphaLower);
    ASSERT_LE(alpha, glsl::alphaUpper(grid));
    if (grid.alphaLower > 0.0f) {
      ASSERT_GE(glsl::voxelHolding(grid, alpha), 1);
    }
  }
}

TEST(VolumeFitTest, CoversEverythingSeenWhereverTheLightIs) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> place(-8.0f, 8.0f);
  int round = 0;
  for (int i = 0; i < 400; ++i) {
    const Camera camera = lookAt("any", {place(random), place(random), place(random)},
                                 {place(random), place(random), place(random)}, 0.5f + 0.002f * static_cast<float>(i));
    const glm::dvec3 lightW(place(random), place(random), place(random));
    const Fitted f = fitFor(lightW, camera, i % 8 == 0 ? VolumeFit::Full : VolumeFit::Frustum, random);
    expectCovered(f);
    if (HasFatalFailure()) FAIL() << i;
    round += i % 8 != 0 && glsl::thetaGoesRound(f.columns.map.epipolar) ? 1 : 0;
  }
  EXPECT_GT(round, 10);
  EXPECT_LT(round, 200);
}

TEST(VolumeFitTest, TheEpipoleOnScreenOffScreenAndBehind) {
  std::mt19937 random(1);
  const Camera camera = lookAt("", {0, 0, 0}, {0, 0, -1}, 1.0f);
  const Fitted onScreen = fitFor({0.3, 0.2, -4.0}, camera, VolumeFit::Frustum, random);
  EXPECT_TRUE(glsl::thetaGoesRound(onScreen.columns.map.epipolar));
  EXPECT_EQ(onScreen.columns.map.epipolar.alphaLower, 0.0f);
  EXPECT_LT(glsl::alphaUpper(onScreen.columns.map.epipolar), 1.0f);
  const Fitted offScreen = fitFor({5.0, 0.2, -1.0}, camera, VolumeFit::Frustum, random);
  EXPECT_FALSE(glsl::thetaGoesRound(offScreen.columns.map.epipolar));
  EXPECT_GT(offScreen.columns.map.epipolar.alphaLower, 0.5f);
  EXPECT_LT(offScreen.columns.map.epipolar.thetaStep * 96.0f, 3.2f);
  const Fitted behind = fitFor({0.3, 0.2, 4.0}, camera, VolumeFit::Frustum, random);
  EXPECT_TRUE(glsl::thetaGoesRound(behind.columns.map.epipolar));
  EXPECT_GT(behind.columns.map.epipolar.alphaLower, 2.0f);
  EXPECT_NEAR(glsl::alphaUpper(behind.columns.map.epipolar), kPi, 0.02);
  const Fitted above = fitFor({0.0, 4.0, 0.0}, camera, VolumeFit::Frustum, random);  // the axis is the camera's up
  EXPECT_FALSE(glsl::thetaGoesRound(above.columns.map.epipolar));
  for (const Fitted* f : {&onScreen, &offScreen, &behind, &above}) expectCovered(*f);
}

// No more than the slack that the fit keeps: what it encloses is what brute force finds.
TEST(VolumeFitTest, TheRangesAreTight) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> place(-8.0f, 8.0f);
  for (int i = 0; i < 100; ++i) {
    const Camera camera = lookAt("any", {place(random), place(random), place(random)},
                                 {place(random), place(random), place(random)}, 0.9f);
    const Fitted f = fitFor({place(random), place(random), place(random)}, camera, VolumeFit::Frustum, random);
    const glsl::EpipolarGrid& grid = f.columns.map.epipolar;
    float alphaLeast = 10.0f, alphaMost = 0.0f, phiMost = 0.0f, stepsLeast = 1e9f, stepsMost = 0.0f;
    for (const glm::dvec3& receiver : f.receivers) {
      const glm::vec3 posL = glsl::lightFromWorld(f.columns.frame, glm::vec3(receiver));
      const glsl::EpipolarPoint at = glsl::epipolarFromLight(grid.eyeDistance, posL);
      alphaLeast = std::min(alphaLeast, at.alpha);
      alphaMost = std::max(alphaMost, at.alpha);
      phiMost = std::max(phiMost, at.phi);
      stepsLeast = std::min(stepsLeast, glsl::thetaSteps(grid, at.theta));
      stepsMost = std::max(stepsMost, glsl::thetaSteps(grid, at.theta));
    }
    // The border is sampled every 2.5% of a picture of about an eighth of a turn; the axis may lie between samples.
    const float sampled = 0.03f;
    EXPECT_GT(grid.alphaLower + 3.0f * grid.alphaStep + sampled, alphaLeast) << i;
    EXPECT_LT(glsl::alphaUpper(grid) - 3.0f * grid.alphaStep - sampled, alphaMost) << i;
    EXPECT_LT(grid.phiStep * static_cast<float>(grid.phiCount - 2), phiMost) << i;
    if (!glsl::thetaGoesRound(grid)) {
      EXPECT_LT(stepsLeast, 1.0f) << i;
      EXPECT_GT(stepsMost, static_cast<float>(grid.thetaCount) - 1.0f) << i;
    }
  }
}

TEST(VolumeFitTest, ALightAtTheEyeIsRefusedByName) {
  std::mt19937 random(1);
  const Camera camera = lookAt("", {1, 2, 3}, {0, 0, -1}, 1.0f);
  try {
    fitFor({1.0, 2.0, 3.0}, camera, VolumeFit::Frustum, random);
    FAIL();
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("the camera's eye"), std::string::npos);
  }
  expectCovered(fitFor({1.0, 2.0, 3.01}, camera, VolumeFit::Frustum, random));
}

TEST(VolumeFitTest, SizesOnTheCommandLine) {
  EXPECT_EQ(kVolumeSize.parse("512x1024x256"), (VolumeSize{.alpha = 512, .theta = 1024, .phi = 256}));
  for (const char* wrong :
       {"", "512", "512x512", "512x512x100", "0x512x128", "512x512x128x", "512 x512x128", "-5x5x128", "99999x2x128"})
    EXPECT_THROW(kVolumeSize.parse(wrong), UsageError) << wrong;
}

}  // namespace
}  // namespace gnomon
