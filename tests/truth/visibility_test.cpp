// The truth: margins, light rays, contact.

#include "scenes_by_hand.h"
#include "shot.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::test {
namespace {

TEST(EndMargin, IsEightUlpsOfTheLargestCoordinate) {
  Scene scene = emptyScene();
  addTriangle(scene, {-1000, 0, 0}, {3, 1, 0}, {0, 0, 5});
  EXPECT_EQ(endMargin(scene), 8.0 * 0x1p-14);  // 1000 lies in [2^9, 2^10): an ulp is 2^(9-23)
}

TEST(LightRays, OfADirectionalLightStartOutsideTheBounds) {
  Scene scene = emptyScene();
  addBox(scene, {-3, 1, 2}, {5, 4, 9});
  std::mt19937 random(19);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const LightModel light = directionalLight({unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5});
    const LightRays rays(scene, light);
    const glm::dvec3 p(-3 + 8 * unit(random), 1 + 3 * unit(random), 2 + 7 * unit(random));
    const LightRay towards = rays.towards(p);
    EXPECT_LT(glm::length(towards.ray.origin + towards.ray.dir * towards.distance - p), 1e-12);
    const glm::dvec3& o = towards.ray.origin;
    EXPECT_TRUE(o.x < -3 || o.x > 5 || o.y < 1 || o.y > 4 || o.z < 2 || o.z > 9);
    const RayD moved = rays.normalized({p + light.directionW * 0.7, light.directionW});
    EXPECT_LT(glm::length(moved.origin - o), 1e-12);
  }
}

// A unit box's shadow on the floor from a light straight above its middle, at the height 3: a square of side 3/2.
TEST(Truth, ShadowOfABoxHasItsAnalyticOutline) {
  Scene scene = emptyScene();
  const int floor = addFloor(scene, 0.0, 10.0);
  addBox(scene, {-0.5, 0, -0.5}, {0.5, 1, 0.5});
  const Shot shot = takeShot(std::move(scene), viewFrom({2, 6, 3}, {0, 0, 0}, 0.7, 300, 300), pointLight({0, 3, 0}));
  size_t dark = 0, bright = 0;
  for (size_t i = 0; i < shot.truth.lit.size(); ++i) {
    const SurfaceSample& sample = shot.receivers.samples[i];
    if (shot.receivers.states[i] != PixelState::Scored || sample.primitive.instance != static_cast<uint32_t>(floor))
      continue;
    ++(shot.truth.lit[i] == 1 ? bright : dark);
    const double reach = std::max(std::abs(sample.positionW.x), std::abs(sample.positionW.z));
    EXPECT_TRUE((shot.truth.lit[i] == 1) == (reach > 0.75) || std::abs(reach - 0.75) < 1e-6) << reach;
  }
  EXPECT_GT(dark, 1000u);
  EXPECT_GT(bright, 10000u);
}

class Contact : public testing::TestWithParam<double> {};

// Boxes stand on the floor, turned and moved so that their corners are rounded; the camera looks at the foot of one.
TEST_P(Contact, TruthIsStableAtTheFootOfABox) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 4.0);
  addBox(scene, {-0.5, 0, -0.5}, {0.5, 1, 0.5});
  addBox(scene, {0.9, 0, -0.3}, {1.1, 2, 0.5});
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), GetParam() * glm::dvec3(1, 0.5, -0.7)) *
                           glm::rotate(glm::dmat4(1.0), 0.4, glm::normalize(glm::dvec3(1, 2, 0.5)));
  moveAll(scene, moved);
  const auto at = [&](double x, double y, double z) { return glm::dvec3(moved * glm::dvec4(x, y, z, 1.0)); };
  const LightModel light = pointLight(glm::dvec3(glm::vec3(at(-2.0, 2.5, 1.7))));
  const glsl::CameraView camera = viewFrom(at(0.6, 0.4, 1.4), at(0.5, 0.0, 0.5), 0.5, 512, 512);
  const Shot shot = takeShot(std::move(scene), camera, light);
  EXPECT_GT(shot.truth.litCount, 10000u);
  EXPECT_GT(shot.receivers.scored - shot.truth.litCount, 10000u);
  // A floor point nearer to the box than the margin is lit by definition; pixels are a thousand margins wide.
  EXPECT_LE(shot.truth.marginFlipsHalf, GetParam() > 100.0 ? 25u : 2u) << shot.receivers.scored;
  EXPECT_LE(shot.truth.marginFlipsDouble, GetParam() > 100.0 ? 25u : 2u);
}

INSTANTIATE_TEST_SUITE_P(MetresFromTheOrigin, Contact, testing::Values(0.0, 10.0, 1000.0));

// A finely tessellated sphere, all of whose lit side must be lit though every pixel lies by some edge.
TEST(Truth, ConvexSurfaceDoesNotShadowItself) {
  for (const double offset : {0.0, 1000.0}) {
    Scene scene = emptyScene();
    const glm::dvec3 center = offset * glm::dvec3(1, 1, -1);
    addSphere(scene, center, 1.0, 60, 120);
    const Shot shot = takeShot(std::move(scene), viewFrom(center + glm::dvec3(2, 2, 3), center, 0.6, 300, 300),
                               pointLight(center + glm::dvec3(5, 4, 1)));
    EXPECT_EQ(shot.truth.litCount, shot.receivers.scored) << offset;
    EXPECT_GT(shot.receivers.scored, 20000u);
  }
}

TEST(Truth, SaysTheSameTwice) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 10.0);
  addSphere(scene, {0, 1, 0}, 0.7, 30, 40);
  const Shot shot = takeShot(std::move(scene), viewFrom({2, 6, 3}, {0, 0, 0}, 0.7, 200, 200), pointLight({0, 3, 0}));
  const Truth again = computeTruth(*shot.tracer, shot.light, shot.receivers);
  EXPECT_EQ(again.lit, shot.truth.lit);
  EXPECT_EQ(again.marginFlipsDouble, shot.truth.marginFlipsDouble);
}

}  // namespace
}  // namespace gnomon::test
