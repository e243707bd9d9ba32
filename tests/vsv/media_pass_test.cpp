// Single scattering in a homogeneous medium on the GPU: against quadratures in double where the answer is
// known, and its ways of integrating against each other.
#include "base/error.h"
#include "media_fixture.h"
#include "shadow/visibility_pass.h"

#include <algorithm>
#include <cmath>

namespace gnomon {
namespace {

using test::MediaSetup;
using test::MediaWorld;
using test::relativeRmse;

const MediaMethod kRuns = mediaMethod("runs"), kBits = mediaMethod("bits"), kPopcount = mediaMethod("popcount");

class MediaPassTest : public gpu::GpuTest {};

struct Place {
  const char* name;
  glm::vec3 eyeW, targetW;
  glm::dvec3 lightW;
  double march512;  // relative RMSE of 512 samples: large where rays pass near the light
};
const Place kPlaces[] = {
    {"light in the picture", {0, 1, 6}, {0.2f, 0.8f, 0}, {0.3, 1.2, 0.5}, 0.02},
    {"light aside", {0, 1, 6}, {0, 1, 0}, {4.0, 2.5, 3.0}, 1e-5},
    {"light behind the camera", {0, 1, 6}, {0, 1, 0}, {0.4, 1.5, 9.0}, 5e-5},
    {"light straight behind the camera", {0, 1, 6}, {0, 1, 0}, {0.0, 1.0, 8.0}, 5e-5},
    {"camera close to the light", {0, 1, 6}, {0, 1, 0}, {0.05, 1.05, 5.98}, 0.005},
    {"light far ahead", {0, 1, 6}, {0, 1, 0}, {0.5, 1.1, -30.0}, 1e-5},
};

double worstRelative(const std::vector<glm::vec3>& measured, const std::vector<glm::vec3>& expected) {
  double worst = 0.0;
  for (size_t i = 0; i < expected.size(); ++i)
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(static_cast<double>(measured[i][c]) / expected[i][c] - 1.0));
  return worst;
}

std::vector<glm::vec3> unshadowedPicture(const MediaWorld& world, double begin = 0.0) {
  std::vector<glm::vec3> picture;
  for (size_t i = 0; i + 1 < world.endsW.size(); ++i)
    picture.emplace_back(test::unshadowedLight(world.setup.medium, world.setup.light, glm::dvec3(world.view.eyeW),
                                               world.endsW[i], begin));
  return picture;
}

// The three that read the table are within 1e-3 of each pixel, which is what the table is made for, and
// within 2e-4 as a whole; 512 samples are as good as the light lets them.
TEST_F(MediaPassTest, WithNothingInTheWayAllWaysGiveTheClosedForm) {
  for (const Place& place : kPlaces) {
    MediaWorld world(device(), test::emptyMediaSetup(place.eyeW, place.targetW, place.lightW));
    const std::vector<glm::vec3> expected = unshadowedPicture(world);
    for (const MediaMethod& method : {kRuns, kBits, kPopcount}) {
      const std::vector<glm::vec3> measured = world.scattered(method);
      EXPECT_LT(worstRelative(measured, expected), 1e-3) << place.name << ", " << method.integrator->name;
      EXPECT_LT(relativeRmse(measured, expected), 2e-4) << place.name << ", " << method.integrator->name;
    }
    for (const bool paraboloid : {false, true})
      EXPECT_LT(relativeRmse(world.scattered(mediaMethod("march", 512), paraboloid), expected), place.march512)
          << place.name << (paraboloid ? ", paraboloid" : ", cube");
  }
}

// From the eye to its end, and in the light map's depths.
TEST_F(MediaPassTest, AFittedVolumeHoldsEveryViewRay) {
  std::vector<MediaSetup> setups = {test::mediaSetup("grate"), test::mediaSetup("atrium"), test::mediaSetup("contact")};
  for (const Place& place : kPlaces) setups.push_back(test::emptyMediaSetup(place.eyeW, place.targetW, place.lightW));
  for (const MediaSetup& setup : setups) {
    const MediaWorld world(device(), setup);
    const FittedMap& columns = world.volume->fitted();
    const glsl::EpipolarGrid& grid = columns.map.epipolar;
    double farthest = 0.0;
    for (const glm::dvec3& end : world.endsW) farthest = std::max(farthest, glm::length(end - setup.light.positionW));
    EXPECT_GE(columns.zFar, farthest * (1.0 - 1e-6));
    for (size_t i = 0; i + 1 < world.endsW.size(); ++i) {
      const glsl::EpipolarPoint end =
          glsl::epipolarFromLight(grid.eyeDistance, glsl::lightFromWorld(columns.frame, glm::vec3(world.endsW[i])));
      ASSERT_GE(end.alpha, grid.alphaLower);
      ASSERT_LE(end.alpha, glsl::alphaUpper(grid));
      ASSERT_LE(glsl::thetaSteps(grid, end.theta), static_cast<float>(grid.thetaCount));
      ASSERT_LE(end.phi, glsl::phiUpper(grid));
      ASSERT_EQ(grid.phiLower, 0.0f);
    }
  }
}

// However thick, forward or backward, and whichever voxels.
TEST_F(MediaPassTest, OtherMediaAndOtherVolumesGiveTheClosedFormToo) {
  struct Case {
    glsl::Medium medium;
    VolumeSize size;
    VolumeFit fit;
    double worst;
  };
  const Case cases[] = {
      {{{1e-3f, 2e-3f, 4e-3f}, {0, 0, 0}, 0.0f, 40.0f}, {512, 512, 512}, VolumeFit::Frustum, 1e-3},
      {{{0.5f, 0.4f, 0.3f}, {0.1f, 0.2f, 0.3f}, -0.6f, 12.0f}, {512, 512, 512}, VolumeFit::Frustum, 1e-3},
      {{{0.05f, 0.04f, 0.03f}, {0, 0, 0}, 0.85f, 12.0f}, {64, 64, 128}, VolumeFit::Frustum, 3e-3},
      {{{0.05f, 0.04f, 0.03f}, {0, 0, 0}, 0.2f, 12.0f}, {512, 512, 512}, VolumeFit::Full, 3e-3},
  };
  for (const Case& c : cases) {
    for (const Place& place : kPlaces) {
      MediaSetup setup = test::emptyMediaSetup(place.eyeW, place.targetW, place.lightW);
      setup.medium = c.medium;
      setup.size = c.size;
      setup.fit = c.fit;
      setup.pictureSide = 24;
      MediaWorld world(device(), setup);
      EXPECT_LT(worstRelative(world.scattered(kRuns), unshadowedPicture(world)), c.worst)
          << place.name << ", g " << c.medium.g << ", " << volumeSizeName(c.size) << ", " << kVolumeFit.text(c.fit);
    }
  }
}

// A spot's cone cuts view rays anywhere; runs and bits cut them at the same place.
TEST_F(MediaPassTest, AConeLightsWhatIsWithin) {
  size_t dark = 0, lit = 0, marched = 0;
  for (const Place& place : kPlaces) {
    for (const glm::dvec3& axis : {glm::dvec3(0.3, -0.4, -0.6), glm::dvec3(-1, 0.1, 0.2), glm::dvec3(0, 0.2, 1)}) {
      MediaSetup setup = test::emptyMediaSetup(place.eyeW, place.targetW, place.lightW);
      setup.light.coneAxisW = glm::normalize(axis);
      setup.light.coneCos = std::cos(0.7);
      setup.pictureSide = 14;
      MediaWorld world(device(), setup);
      const std::vector<glm::vec3> expected = unshadowedPicture(world);
      if (std::ranges::all_of(expected, [](const glm::vec3& light) { return light == glm::vec3(0.0f); })) {
        EXPECT_TRUE(std::ranges::all_of(world.scattered(kRuns),
                                        [](const glm::vec3& light) { return light == glm::vec3(0.0f); }));
        ++dark;
        continue;
      }
      ++lit;
      EXPECT_LT(relativeRmse(world.scattered(kRuns), expected), 2e-3) << place.name;
      EXPECT_LT(relativeRmse(world.scattered(kBits), expected), 2e-3) << place.name;
      EXPECT_LT(relativeRmse(world.scattered(kPopcount), expected), 0.05) << place.name;  // counts whole bins
      if (place.march512 < 1e-3) {  // elsewhere the cone's edge is lost between samples near the light
        EXPECT_LT(relativeRmse(world.scattered(mediaMethod("march", 512)), expected), 0.03) << place.name;
        ++marched;
      }
    }
  }
  // Of six places and three axes; and of the five places that march512 lets in.
  EXPECT_EQ(dark, 8u);
  EXPECT_EQ(lit, 10u);
  EXPECT_EQ(marched, 5u);
}

// Up to a hemisphere and beyond, pointing away from the eye: the lit stretch ends at the ray's end, not at the cone.
TEST_F(MediaPassTest, AWideConeTurnedAwayFromTheEyeLightsWhatIsWithin) {
  size_t lit = 0;
  for (const double halfAngle : {1.2, 1.57, 2.8}) {
    for (const Place& place : kPlaces) {
      MediaSetup setup = test::emptyMediaSetup(place.eyeW, place.targetW, place.lightW);
      setup.light.coneAxisW = glm::normalize(place.lightW - glm::dvec3(place.eyeW));
      setup.light.coneCos = std::cos(halfAngle);
      setup.pictureSide = 14;
      MediaWorld world(device(), setup);
      const std::vector<glm::vec3> expected = unshadowedPicture(world);
      if (std::ranges::all_of(expected, [](const glm::vec3& light) { return light == glm::vec3(0.0f); })) continue;
      ++lit;
      for (const MediaMethod& method : {kRuns, kBits})
        EXPECT_LT(relativeRmse(world.scattered(method), expected), 1e-3)
            << place.name << ", " << halfAngle << ", " << method.integrator->name;
    }
  }
  EXPECT_EQ(lit, 11u);  // of six places and three cones
}

// Below a shelf that ends under the light everything on its side is dark: rays come from the dark into the
// light where they pass under the light.
//
//             L
//   ------shelf
//     dark    |  lit
TEST_F(MediaPassTest, AHalfSpaceInShadowIsDarkAndTheOtherIsLit) {
  MediaSetup setup = test::emptyMediaSetup({-3.0f, 0.0f, 0.0f}, {3.0f, -0.3f, -1.0f}, {0.5, 2.0, -1.0});
  Mesh& shelf = setup.scene.meshes.front();
  shelf.positions = {{-60, 1.5f, -60}, {0.5f, 1.5f, -60}, {0.5f, 1.5f, 60}, {-60, 1.5f, 60}};
  shelf.normals.assign(4, {0, 1, 0});
  shelf.uvs.resize(4);
  shelf.indices = {0, 1, 2, 0, 2, 3};
  setup.scene.materials.front().doubleSided = true;
  setup.camera.yFovRad = 0.5f;
  setup.size = {.alpha = 512, .theta = 512, .phi = 512};
  MediaWorld world(device(), setup);
  std::vector<glm::vec3> expected;
  for (size_t i = 0; i + 1 < world.endsW.size(); ++i) {
    const glm::dvec3 eye(world.view.eyeW);
    const glm::dvec3 toEnd = world.endsW[i] - eye;
    const double s = (0.5 - eye.x) / toEnd.x * glm::length(toEnd);
    expected.emplace_back(test::unshadowedLight(setup.medium, setup.light, eye, world.endsW[i], s));
  }
  // The border lies within a bin of phi and a column of theta of where it is.
  for (const MediaMethod& method : {kRuns, kBits}) {
    const std::vector<glm::vec3> measured = world.scattered(method);
    EXPECT_LT(relativeRmse(measured, expected), 0.01);
    EXPECT_LT(worstRelative(measured, expected), 0.02);
  }
  EXPECT_LT(relativeRmse(world.scattered(mediaMethod("march", 1024)), expected), 0.01);
}

// Each run is the sum of its bits: they differ by the rounding of up to 512 sums, each by 2^-24 of the
// largest partial sum; here 1e-5 of the pixel, and where the pixel is dark of what it would be in the light.
TEST_F(MediaPassTest, RunsAreBitsUpToRounding) {
  for (const char* scene : {"grate", "atrium"}) {
    for (const VolumeSource source : {VolumeSource::Direct, VolumeSource::Resample}) {
      MediaSetup setup = test::mediaSetup(scene);
      setup.source = source;
      MediaWorld world(device(), setup);
      const std::vector<glm::vec3> runs = world.scattered(kRuns), bits = world.scattered(kBits);
      world.removeShadows();
      const std::vector<glm::vec3> lit = world.scattered(kRuns);
      double worst = 0.0;
      for (size_t i = 0; i < runs.size(); ++i)
        worst = std::max(worst, std::abs(static_cast<double>(runs[i].x) - bits[i].x) / lit[i].x);
      EXPECT_LT(worst, 1e-5);
      EXPECT_LT(relativeRmse(runs, lit), 2.0);
      EXPECT_GT(relativeRmse(runs, lit), 0.02);  // there are shadows
    }
  }
}

TEST_F(MediaPassTest, EnergyIsNeverNegativeAndNeverAboveTheUnshadowed) {
  for (const char* scene : {"grate", "atrium"}) {
    MediaWorld world(device(), test::mediaSetup(scene));
    const std::vector<MediaMethod> methods = {kRuns, kBits, kPopcount, mediaMethod("march", 64)};
    std::vector<std::vector<glm::vec3>> shadowed, lit;
    for (const MediaMethod& method : methods) shadowed.push_back(world.scattered(method));
    world.removeShadows();
    for (const MediaMethod& method : methods) lit.push_back(world.scattered(method));
    for (size_t m = 0; m < methods.size(); ++m) {
      size_t darker = 0;
      for (size_t i = 0; i < lit[m].size(); ++i) {
        for (int c = 0; c < 3; ++c) {
          ASSERT_GE(shadowed[m][i][c], 0.0f);
          ASSERT_LE(shadowed[m][i][c], lit[m][i][c] * (1.0f + 1e-5f)) << methods[m].integrator->name;
        }
        darker += shadowed[m][i].x < 0.95f * lit[m][i].x ? 1 : 0;
      }
      EXPECT_GT(darker, lit[m].size() / 10);
    }
  }
}

// Marching ever finer comes nearer to the bits, as far as a map's texels and a volume's voxels see the same.
TEST_F(MediaPassTest, AMarchThroughTheMapComesNearTheBits) {
  MediaSetup setup = test::mediaSetup("grate");
  setup.camera = setup.scene.cameras.at(1);
  setup.size = {.alpha = 1024, .theta = 1024, .phi = 512};
  setup.mapSide = 1024;
  MediaWorld world(device(), setup);
  const std::vector<glm::vec3> runs = world.scattered(kRuns);
  for (const bool paraboloid : {false, true}) {
    const double coarse = relativeRmse(world.scattered(mediaMethod("march", 32), paraboloid), runs);
    const double fine = relativeRmse(world.scattered(mediaMethod("march", 512), paraboloid), runs);
    EXPECT_LT(fine, 0.5 * coarse);
    EXPECT_LT(fine, 0.05);
  }
}

TEST_F(MediaPassTest, LightsAddUp) {
  MediaWorld world(device(), test::mediaSetup("grate"));
  const std::vector<glm::vec3> once = world.scattered(kRuns);
  gpu::Commands commands(device(), "two lights");
  for (const bool add : {false, true}) {
    world.pass.recordTable(commands, *world.volume, world.setup.light);
    commands.barrier("the running integral is written -> pixels read it");
    world.pass.record(commands, world.buffers, world.gbuffer, *world.volume, world.setup.light, kRuns, add);
    commands.barrier("one light's scattering is written -> the next is added");
  }
  commands.submitAndWait();
  const auto twice = gpu::downloadAs<glm::vec3>(device(), world.pass.inScattered());
  for (size_t i = 0; i < once.size(); ++i) ASSERT_EQ(twice[i], once[i] * 2.0f);
}

// Through a medium a surface sends exp(-sigmaT (s + r)) of what it sends without one.
TEST_F(MediaPassTest, SurfacesAreAttenuatedAlongBothLegs) {
  MediaWorld world(device(), test::mediaSetup("contact"));
  world.setup.medium.sigmaA = {0.05f, 0.0f, 0.2f};
  VisibilityPass visibility(device(), world.view.width, world.view.height);
  RadiancePass plain(device(), world.view.width, world.view.height);
  const LightModel light{.type = LightType::Point, .positionW = world.setup.light.positionW};
  glsl::ShadeUniforms shade = shadeUniforms(world.view, light, {});
  shade.lightColor = world.setup.light.intensity / glsl::kPi;
  visibility.setUniforms(shade);
  world.pass.setMedium(world.view, world.setup.medium);
  gpu::Commands commands(device(), "surfaces");
  visibility.record(commands, world.buffers, world.gbuffer, *world.cube, {.bias = findBias("adaptive")});
  world.pass.recordTable(commands, *world.volume, world.setup.light);
  commands.barrier("visibility and table are written -> surfaces and pixels read them");
  plain.record(commands, world.buffers, world.gbuffer, visibility.uniforms(), visibility.visibility());
  world.pass.recordSurfaces(commands, world.buffers, world.gbuffer, world.setup.light, visibility.uniforms(),
                            visibility.visibility(), false);
  world.pass.record(commands, world.buffers, world.gbuffer, *world.volume, world.setup.light, kRuns, false);
  commands.barrier("both are written -> the sum reads them");
  world.pass.recordSum(commands);
  commands.submitAndWait();
  const auto clear = gpu::downloadAs<glm::vec3>(device(), plain.radiance());
  const auto surfaces = gpu::downloadAs<glm::vec3>(device(), world.pass.surfaces());
  const auto scattered = gpu::downloadAs<glm::vec3>(device(), world.pass.inScattered());
  const auto both = gpu::downloadAs<glm::vec3>(device(), world.pass.radiance());
  size_t seen = 0;
  double worst = 0.0;
  for (size_t i = 0; i < clear.size(); ++i) {
    const glm::dvec3 at = world.receivers.samples[i].positionW;
    const double path = glm::length(at - glm::dvec3(world.view.eyeW)) + glm::length(at - world.setup.light.positionW);
    for (int c = 0; c < 3; ++c) {
      const double expected =
          clear[i][c] *
          std::exp(-path * (world.setup.medium.sigmaS[c] + static_cast<double>(world.setup.medium.sigmaA[c])));
      worst = std::max(worst, expected > 0.0 ? std::abs(surfaces[i][c] / expected - 1.0) : 0.0);
      ASSERT_EQ(both[i][c], surfaces[i][c] + scattered[i][c]);
    }
    seen += clear[i].x > 0.0f ? 1 : 0;
  }
  EXPECT_LT(worst, 5e-5);  // a GPU's exp, and positions in float
  EXPECT_GT(seen, clear.size() / 10);
}

TEST(MediaLights, PointsAndSpotsAreTakenAndSunsAreNot) {
  Light light{.name = "sun", .type = LightType::Directional};
  try {
    mediaLight(light);
    ADD_FAILURE() << "a directional light was taken";
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("'sun'"), std::string::npos);
  }
  light.type = LightType::Spot;
  light.outerConeRad = 0.5f;
  light.color = {1.0f, 0.5f, 0.0f};
  light.intensity = 4.0f;
  EXPECT_NEAR(mediaLight(light).coneCos, std::cos(0.5), 1e-7);
  EXPECT_EQ(mediaLight(light).intensity, glm::vec3(4.0f, 2.0f, 0.0f));
  light.type = LightType::Point;
  EXPECT_EQ(mediaLight(light).coneCos, -1.0);
}

TEST(Integrators, HaveOneBaselineAndOneThatStandsForThoseThatReadTheSame) {
  EXPECT_EQ(std::ranges::count_if(integrators(), &Integrator::isBaseline), 1);
  EXPECT_STREQ(baselineIntegrator().name, "march");
  for (const Integrator::Reads reads : {Integrator::Reads::Bits, Integrator::Reads::Depths})
    EXPECT_EQ(std::ranges::count_if(integrators(),
                                    [&](const Integrator& i) { return i.reads == reads && i.standsInDensity; }),
              1);
  EXPECT_STREQ(integratorInDensity(findIntegrator("popcount")).name, "bits");
  EXPECT_STREQ(integratorInDensity(findIntegrator("march")).name, "march");
}

TEST(Integrators, HaveNames) {
  for (const char* name : {"runs", "bits", "popcount", "march"}) EXPECT_STREQ(findIntegrator(name).name, name);
  EXPECT_THROW(findIntegrator("walk"), UsageError);
}

}  // namespace
}  // namespace gnomon
