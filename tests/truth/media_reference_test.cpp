// The media reference against closed forms and against sums that share nothing with it.

#include "scenes_by_hand.h"
#include "shot.h"

#include "scene/gbuffer.h"
#include "scene/generate.h"
#include "truth/media_reference.h"
#include "truth/scattering.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace gnomon::test {
namespace {

constexpr double kPi = std::numbers::pi;

using Lit = std::function<bool(const glm::dvec3& posW)>;
using DensityAt = std::function<double(const glm::dvec3& posW)>;

class Field : public DensityField {
 public:
  Field(DensityAt density, const Bounds& boundsW, double voxel)
      : density_(std::move(density)), boundsW_(boundsW), voxel_(voxel) {}
  double at(const glm::dvec3& posW) const override { return density_(posW); }
  Bounds boundsW() const override { return boundsW_; }
  double voxelMetres() const override { return voxel_; }

 private:
  DensityAt density_;
  Bounds boundsW_;
  double voxel_;
};

// The integral by its first formula, midpoints at equal distances: nothing of the reference's.
glm::dvec3 plainSum(const RayD& view, double end, const MediaLight& light, const MediumModel& medium, const Lit& lit,
                    int steps) {
  const glm::dvec3 sigmaT = medium.sigmaS + medium.sigmaA;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < steps; ++i) {
    const double s = end * (i + 0.5) / steps;
    const glm::dvec3 posW = view.origin + view.dir * s;
    if (!lit(posW)) continue;
    const glm::dvec3 towards = posW - light.positionW;
    const double r = glm::length(towards);
    const double cosine = glm::dot(towards / r, -view.dir);
    const double g = medium.g;
    const double phase = (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
    sum += medium.sigmaS * light.intensity * glm::exp(-sigmaT * (s + r)) * (phase / (r * r) * end / steps);
  }
  return sum;
}

const Lit kEverywhere = [](const glm::dvec3&) { return true; };

struct Setting {
  Scene scene = emptyScene();
  glsl::CameraView camera{};
  std::vector<MediaLight> lights{{.positionW = {0.3, 2.0, -1.0}, .intensity = {10.0, 6.0, 3.0}}};
  MediumModel medium{.sigmaS = {0.05, 0.08, 0.1}, .sigmaA = {0.02, 0.0, 0.01}, .g = 0.4, .reach = 12.0};
};

struct Referred {
  std::vector<double> ends;
  MediaReference reference;
};

Referred refer(const Setting& setting, const MediaReferenceOptions& options = {}) {
  const Tracer tracer(setting.scene);
  const Receivers receivers = computeReceivers(tracer, setting.camera, pointLight(setting.lights[0].positionW),
                                               traceIds(tracer, setting.camera));
  Referred referred{.ends = viewRayEnds(setting.camera, receivers, setting.medium.reach)};
  referred.reference =
      computeMediaReference(tracer, setting.lights, setting.camera, referred.ends, setting.medium, options);
  return referred;
}

// The largest difference from the plain sums, of the reference's mean.
double worstDifference(const Setting& setting, const Referred& referred, const Lit& lit, int steps) {
  double worst = 0.0;
  for (int y = 0; y < setting.camera.height; ++y) {
    for (int x = 0; x < setting.camera.width; ++x) {
      const auto pixel = static_cast<size_t>(y * setting.camera.width + x);
      glm::dvec3 sum(0.0);
      for (const MediaLight& light : setting.lights)
        sum += plainSum(pixelRay(setting.camera, x, y), referred.ends[pixel], light, setting.medium, lit, steps);
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(static_cast<double>(referred.reference.inScattered.at(x, y)[c]) - sum[c]));
    }
  }
  return worst / referred.reference.mean;
}

// In front, aside, behind, near to the eye, and looking away.
class Unshadowed : public testing::TestWithParam<glm::dvec3> {};

TEST_P(Unshadowed, IsThePlainIntegral) {
  Setting setting;
  setting.lights[0].positionW = GetParam();
  setting.camera = viewFrom({0, 1, 4}, {0, 1, 0}, 0.9, 12, 9);
  const Referred referred = refer(setting);
  EXPECT_LT(worstDifference(setting, referred, kEverywhere, 200000), 1e-5);
  EXPECT_EQ(referred.reference.atLimit, 0u);
}

INSTANTIATE_TEST_SUITE_P(Lights, Unshadowed,
                         testing::Values(glm::dvec3(0.33, 1.2, -1.0), glm::dvec3(5, 2, 3), glm::dvec3(0.1, 1, 9),
                                         glm::dvec3(0.02, 1.03, 3.9)));

// With hardly any extinction the integral of dphi / aside is the angle at the light over the distance of the ray.
TEST(MediaReference, AThinMediumGivesTheAngleAtTheLight) {
  Setting setting;
  setting.medium = {.sigmaS = glm::dvec3(1e-9), .g = 0.0, .reach = 7.0};
  setting.camera = viewFrom({0, 1, 4}, {0, 1, 0}, 0.9, 8, 6);
  const Referred referred = refer(setting);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      const RayD view = pixelRay(setting.camera, x, y);
      const glm::dvec3 fromLight = view.origin - setting.lights[0].positionW;
      const glm::dvec3 toEnd = fromLight + view.dir * 7.0;
      const double angle = std::atan2(glm::length(glm::cross(fromLight, toEnd)), glm::dot(fromLight, toEnd));
      const double aside = glm::length(glm::cross(fromLight, view.dir));
      const double expected = 1e-9 * setting.lights[0].intensity.x / (4.0 * kPi) * angle / aside;
      EXPECT_NEAR(static_cast<double>(referred.reference.inScattered.at(x, y)[0]) / expected, 1.0, 1e-6);
    }
  }
}

// A half plane at the height 1 from x = 0 on: below it all is dark where x > 0, seen from a light above x = 0.
TEST(MediaReference, BehindAHalfPlaneTheLitStretchIsKnown) {
  Setting setting;
  addQuad(setting.scene, {0, 1, -500}, {1000, 1, -500}, {1000, 1, 500}, {0, 1, 500});
  setting.lights[0].positionW = {0, 2, 0};
  setting.camera = viewFrom({-3, 0.2, 1}, {1, 0.4, 0}, 0.5, 24, 18);
  const Referred referred = refer(setting);
  const Lit lit = [](const glm::dvec3& p) { return p.y > 1.0 || p.x < 0.0; };
  EXPECT_LT(worstDifference(setting, referred, lit, 200000), 1e-3);
  EXPECT_LT(referred.reference.worstChange, referred.reference.bound);
  // Something of it is dark.
  EXPECT_GT(worstDifference(setting, referred, kEverywhere, 2000), 0.1);
}

// The shadow of a sphere is a cone behind the circle where rays touch it. 512 sides' silhouette lies within
// 2e-5 of the radius, and a shaft's edge through a pixel moves by as much.
TEST(MediaReference, BehindASphereTheShadowIsACone) {
  Setting setting;
  const glm::dvec3 center(0, 1, 0);
  const double radius = 0.5;
  addSphere(setting.scene, center, radius, 256, 512);
  setting.lights[0].positionW = {0, 3, 0.5};
  setting.camera = viewFrom({4, 0.5, 0.3}, {0, 0.2, 0}, 0.5, 16, 16);
  const Referred referred = refer(setting);
  const glm::dvec3 light = setting.lights[0].positionW;
  const Lit lit = [&](const glm::dvec3& p) {
    const glm::dvec3 towards = p - light, axis = center - light;
    const double distance = glm::length(axis), r = glm::length(towards);
    const bool inCone =
        glm::dot(towards, axis) / (r * distance) > std::sqrt(1.0 - radius * radius / (distance * distance));
    return !(inCone && r > std::sqrt(distance * distance - radius * radius)) && glm::length(p - center) > radius;
  };
  EXPECT_LT(worstDifference(setting, referred, lit, 100000), 1e-3);
  EXPECT_GT(worstDifference(setting, referred, kEverywhere, 2000), 0.05);
}

TEST(MediaReference, ASpotLightsItsConeOnly) {
  Setting setting;
  setting.lights[0].positionW = {0, 3, 0};
  setting.lights[0].axisW = glm::normalize(glm::dvec3(0.2, -1, 0));
  setting.lights[0].cosCone = std::cos(0.4);
  setting.camera = viewFrom({0, 0.5, 5}, {0, 0.5, 0}, 0.5, 16, 12);
  const Referred referred = refer(setting);
  const MediaLight light = setting.lights[0];
  const Lit lit = [&](const glm::dvec3& p) {
    return glm::dot(glm::normalize(p - light.positionW), light.axisW) >= light.cosCone;
  };
  EXPECT_LT(worstDifference(setting, referred, lit, 200000), 1e-3);
}

TEST(MediaReference, LightsAddUp) {
  Setting setting;
  addBox(setting.scene, {-0.5, 0, -0.5}, {0.5, 1, 0.5});
  setting.camera = viewFrom({2, 1.5, 5}, {0, 0.5, 0}, 0.7, 20, 15);
  setting.lights.push_back({.positionW = {-2, 1, 1}, .intensity = {4, 4, 9}});
  const Referred both = refer(setting);
  Setting one = setting, other = setting;
  one.lights.pop_back();
  other.lights.erase(other.lights.begin());
  const Referred first = refer(one), second = refer(other);
  for (size_t i = 0; i < both.reference.inScattered.values.size(); ++i)
    EXPECT_NEAR(both.reference.inScattered.values[i],
                first.reference.inScattered.values[i] + second.reference.inScattered.values[i],
                2e-3 * both.reference.mean);
}

Setting grate() {
  Setting setting;
  setting.scene = openScene("grate");
  const Light& light = setting.scene.lights.front();
  setting.lights[0] = {.positionW = glm::dvec3(light.positionW),
                       .intensity = glm::dvec3(light.color * light.intensity)};
  setting.camera = cameraView(setting.scene.cameras.front(), 40, 30);
  setting.medium.reach = static_cast<double>(computeBounds(setting.scene).diagonal());
  return setting;
}

TEST(MediaReference, EightTimesTheSamplesChangeNoPixelBeyondTheBound) {
  const Setting setting = grate();
  const Referred usual = refer(setting);
  const Referred finer = refer(setting, {.firstSamples = 2048});
  ASSERT_EQ(usual.reference.atLimit, 0u);
  double worst = 0.0;
  for (size_t i = 0; i < usual.reference.inScattered.values.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(usual.reference.inScattered.values[i]) -
                                     static_cast<double>(finer.reference.inScattered.values[i])));
  EXPECT_LT(worst / finer.reference.mean, usual.reference.bound);
  // The bars do throw shafts that one sample a ray could not know.
  EXPECT_GT(usual.reference.doublings, 2);
}

TEST(MediaReference, IsTheSameOnOneThread) {
  const Setting setting = grate();
  const Referred many = refer(setting);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Referred alone = refer(setting);
  EXPECT_EQ(many.reference.inScattered.values, alone.reference.inScattered.values);
  EXPECT_EQ(many.reference.rays, alone.reference.rays);
  EXPECT_EQ(many.reference.worstChange, alone.reference.worstChange);
}

TEST(MediaReference, TellsThatTheDoublingsRanOut) {
  const Referred referred = refer(grate(), {.bound = 1e-9, .mostDoublings = 2});
  EXPECT_GT(referred.reference.atLimit, 0u);
  EXPECT_GT(referred.reference.worstChange, 1e-9);
}

TEST(MediaReference, OfADarkSceneIsBlackAndEnds) {
  Setting setting;
  addBox(setting.scene, {-0.5, 1.5, -0.5}, {0.5, 2.5, 0.5});  // around the light
  setting.lights[0].positionW = {0, 2, 0};
  setting.camera = viewFrom({3, 1, 3}, {0, 0, 0}, 0.5, 8, 8);
  const Referred referred = refer(setting);
  for (const float value : referred.reference.inScattered.values) EXPECT_EQ(value, 0.0f);
  EXPECT_EQ(referred.reference.worstChange, 0.0);
}

TEST(MediaReference, AConstantDensityIsTheHomogeneousMedium) {
  Setting setting;
  addBox(setting.scene, {-0.5, 0, -0.5}, {0.5, 1, 0.5});
  setting.camera = viewFrom({2, 1.5, 5}, {0, 0.5, 0}, 0.7, 20, 15);
  const Referred homogeneous = refer(setting);
  const Field everywhere([](const glm::dvec3&) { return 1.0; }, {glm::vec3(-40.0f), glm::vec3(40.0f)}, 0.25);
  setting.medium.density = &everywhere;
  const Referred field = refer(setting);
  double worst = 0.0;
  for (size_t i = 0; i < field.reference.inScattered.values.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(field.reference.inScattered.values[i]) -
                                     static_cast<double>(homogeneous.reference.inScattered.values[i])));
  EXPECT_LT(worst / homogeneous.reference.mean, homogeneous.reference.bound);
}

// Light and eye on either side of a slab of twice the density, nothing elsewhere: the depths of both legs by
// similar triangles.
TEST(MediaReference, ASlabOfDensityDimsBothLegs) {
  Setting setting;
  const Bounds slab{{-50, -50, -0.5f}, {50, 50, 0.5f}};
  const Field field([](const glm::dvec3&) { return 2.0; }, slab, 0.1);
  setting.medium = {.sigmaS = {0.3, 0.2, 0.1}, .sigmaA = {0.1, 0.1, 0.4}, .g = -0.3, .reach = 9.0};
  setting.medium.density = &field;
  setting.lights[0].positionW = {0.5, 1.0, -2.0};
  setting.camera = viewFrom({0, 0.4, 3}, {0, 0.5, 0}, 0.9, 10, 8);
  const Referred referred = refer(setting);
  const MediaLight light = setting.lights[0];
  const glm::dvec3 sigmaS = 2.0 * setting.medium.sigmaS, sigmaT = sigmaS + 2.0 * setting.medium.sigmaA;
  double worst = 0.0;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 10; ++x) {
      const RayD view = pixelRay(setting.camera, x, y);
      const double from = (0.5 - view.origin.z) / view.dir.z, to = (-0.5 - view.origin.z) / view.dir.z;
      constexpr int kSteps = 20000;
      glm::dvec3 sum(0.0);
      for (int i = 0; i < kSteps; ++i) {
        const double s = from + (to - from) * (i + 0.5) / kSteps;
        const glm::dvec3 towards = view.origin + view.dir * s - light.positionW;
        const double r = glm::length(towards);
        const double within = r * (towards.z + light.positionW.z + 0.5) / towards.z;
        sum += sigmaS * light.intensity * glm::exp(-sigmaT * (s - from + within)) *
               (phaseFunction(-0.3, glm::dot(towards / r, -view.dir)) / (r * r) * (to - from) / kSteps);
      }
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(static_cast<double>(referred.reference.inScattered.at(x, y)[c]) - sum[c]));
    }
  }
  EXPECT_LT(worst / referred.reference.mean, referred.reference.bound);
}

TEST(PhaseFunction, IntegratesToOneAndHasItsMeanCosine) {
  for (const double g : {-0.7, 0.0, 0.2, 0.9}) {
    double sum = 0.0, mean = 0.0;
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = -1.0 + 2.0 * (i + 0.5) / kSteps;
      const double share = phaseFunction(g, cosine) * 2.0 * kPi * 2.0 / kSteps;
      sum += share;
      mean += share * cosine;
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
    EXPECT_NEAR(mean, g, 1e-6);
  }
}

TEST(ScatteringRay, DistanceAndAngleAreEachOthersInverse) {
  for (const glm::dvec3 light :
       {glm::dvec3(1, 2, -5), glm::dvec3(1e-6, 0, -5), glm::dvec3(0, 1e-6, 3), glm::dvec3(0, 0, -2)}) {
    const ScatteringRay ray = scatteringRay({{0, 0, 0}, {0, 0, -1}}, 8.0, {.positionW = light}, {});
    for (double s = 0.125; s < 8.0; s += 0.25) {
      const double phi = ray.phiAt(s);
      // Behind the light an angle near pi holds a distance to 2^-52 / (pi - phi).
      const double rounding = 0x1p-49 * s / std::max(std::min(kPi - phi, 1.0), 1e-9);
      EXPECT_NEAR(ray.sAt(phi), s, rounding) << light.x << " " << light.z;
    }
  }
}

TEST(BlockPoints, OnlyWhatStandsBeforeThePointBlocks) {
  Scene scene = emptyScene();
  addFloor(scene, 1.0, 4.0);
  const int leaf = addQuad(scene, {-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1});
  scene.meshes[static_cast<size_t>(leaf)].material = addMaskMaterial(scene);
  const Tracer tracer(scene);
  std::vector<glm::dvec3> points;
  std::vector<uint8_t> expected;
  const glm::dvec3 light(0.0, 3.0, 0.0);
  // At the heights of the leaf and of the floor a point within rounding of them is not behind them: 1e-12 m
  // is some hundred ulps of double, and no float could tell.
  for (const double height : {2.5, 2.0 + 1e-12, 2.0 - 1e-12, 1.5, 1.0 + 1e-12, 1.0 - 1e-12, 0.5}) {
    for (const double across : {-0.15, 0.15}) {  // at height 2: through the hole, through the leaf
      points.push_back(glm::dvec3(across, -1.0, 0.1 * across) * (3.0 - height) + light);
      const bool belowLeaf = height < 2.0 && across > 0.0;
      expected.push_back(belowLeaf || height < 1.0 ? 1 : 0);
    }
  }
  std::vector<uint8_t> blocked(points.size(), 7);
  tracer.blockPoints(light, points, blocked);
  for (size_t i = 0; i < points.size(); ++i) EXPECT_EQ(blocked[i], expected[i]) << points[i].x << " " << points[i].y;
}

}  // namespace
}  // namespace gnomon::test
