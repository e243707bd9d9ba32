// One piece or two, seen from the light.

#include "scenes_by_hand.h"
#include "shot.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::test {
namespace {

const glm::dvec3 kLight(0.2, 6.0, -0.3);

RayD from(const glm::dvec3& lightW, const glm::dvec3& to) {
  return {lightW, glm::normalize(to - lightW)};
}

bool continuous(const Tracer& tracer, const glm::dvec3& a, const glm::dvec3& b) {
  const double margin = endMargin(tracer.scene());
  const bool there = continuousBetween(tracer, from(kLight, a), from(kLight, b), margin);
  EXPECT_EQ(there, continuousBetween(tracer, from(kLight, b), from(kLight, a), margin)) << "not symmetric";
  return there;
}

bool continuous(const Scene& scene, const glm::dvec3& a, const glm::dvec3& b) {
  return continuous(Tracer(scene), a, b);
}

TEST(Continuity, ConvexCreaseIsOnePiece) {
  Scene scene = emptyScene();
  addQuad(scene, {0, 1, -5}, {0, 1, 5}, {5, -3, 5}, {5, -3, -5});
  addQuad(scene, {0, 1, -5}, {-5, -3, -5}, {-5, -3, 5}, {0, 1, 5});
  EXPECT_TRUE(continuous(scene, {0.4, 0.68, 0.1}, {-0.3, 0.76, 0.3}));
  EXPECT_TRUE(continuous(scene, {0.01, 0.992, 0.1}, {-0.02, 0.984, 0.1}));
}

TEST(Continuity, ConcaveCornerIsOnePiece) {
  Scene scene = emptyScene();
  addQuad(scene, {0, 0, -5}, {0, 0, 5}, {5, 0, 5}, {5, 0, -5});
  addQuad(scene, {-0.5, -1, -5}, {-0.5, 4, -5}, {-0.5, 4, 5}, {-0.5, -1, 5});  // passes through the floor's level
  addQuad(scene, {-2, 0, -5}, {-2, 0, 5}, {0, 0, 5}, {0, 0, -5});
  EXPECT_TRUE(continuous(scene, {1.0, 0, 0.2}, {-0.5, 1.0, 0.3}));
  EXPECT_TRUE(continuous(scene, {-0.49, 0, 0.2}, {-0.5, 0.01, 0.2}));
}

TEST(Continuity, TessellatedSphereIsOnePiece) {
  for (const int rings : {8, 40, 300}) {
    Scene scene = emptyScene();
    addSphere(scene, {0, 1, 0}, 1.0, rings, 2 * rings);
    const Tracer tracer(scene);
    std::mt19937 random(23);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 a = glm::normalize(glm::dvec3(unit(random), 1.2, unit(random)));
      const glm::dvec3 b = glm::normalize(a + 0.05 * glm::dvec3(unit(random), unit(random), unit(random)));
      EXPECT_TRUE(continuous(tracer, glm::dvec3(0, 1, 0) + 0.99 * a, glm::dvec3(0, 1, 0) + 0.99 * b))
          << rings << " " << i;
    }
  }
}

// Two triangles of one plane that the light all but looks along: 0.1 degrees.
TEST(Continuity, SteepPlaneIsOnePiece) {
  Scene scene = emptyScene();
  addQuad(scene, {0.21, 5, -3}, {0.21, 5, 3}, {0.22, -3, 3}, {0.22, -3, -3});
  EXPECT_TRUE(continuous(scene, {0.212, 3.4, -1.0}, {0.219, -2.2, 1.0}));
}

// A crease whose one wall is as steep as that, so that distance leaps without a silhouette.
TEST(Continuity, SteepCreaseIsOnePiece) {
  for (const double lean : {0.5, 0.05, 0.002}) {
    Scene scene = emptyScene();
    addQuad(scene, {0.2, 4, -3}, {0.2, 4, 3}, {-3, 4.2, 3}, {-3, 4.2, -3});
    addQuad(scene, {0.2, 4, -3}, {0.2, 4, 3}, {0.2 + lean, 0, 3}, {0.2 + lean, 0, -3});
    addQuad(scene, {0.2 + lean, 0, -3}, {0.2 + lean, 0, 3}, {3, 0, 3}, {3, 0, -3});
    EXPECT_TRUE(continuous(scene, {0.1, 4.00625, 0.1}, {1.0, 0, 0.2})) << lean;
  }
}

// The smallest step between two parallel plates that counts as one, over rays a decimetre apart: a thousandth
// of that, times what slopes are forgiven.
TEST(Continuity, SeparatePlanesAreTwoPieces) {
  for (const double step : {3.0, 0.1, 0.002}) {
    Scene scene = emptyScene();
    addQuad(scene, {-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5});
    addQuad(scene, {-5, step, -5}, {-5, step, 5}, {0, step, 5}, {0, step, -5});
    EXPECT_FALSE(continuous(scene, {0.05, 0, 0.1}, {-0.05, step, 0.1})) << step;
  }
}

TEST(Continuity, StepsBelowTheMarginAreOnePiece) {
  Scene scene = emptyScene();
  addQuad(scene, {-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5});
  const double step = 0.5 * endMargin(scene);
  addQuad(scene, {-5, step, -5}, {-5, step, 5}, {0, step, 5}, {0, step, -5});
  EXPECT_TRUE(continuous(scene, {0.05, 0, 0.1}, {-0.05, step, 0.1}));
}

// A leaning slab that hides its own foot: its plane, extended, meets the floor between the rays, and its
// triangles touch the floor as well, but not where the light looks past its upper border.
TEST(Continuity, SlabThatLeansOverItsFootIsTwoPieces) {
  Scene scene = emptyScene();
  addTriangle(scene, {-30, 0, 30}, {30, 0, 30}, {0, 0, -60});
  addTriangle(scene, {-1, 0, -30}, {-1, 0, 30}, {0, 2, 0.1});
  EXPECT_FALSE(continuous(scene, {-0.05, 1.9, 0.1}, {0.05, 0, 0.1}));
  EXPECT_FALSE(continuous(scene, {-0.5, 1.0, 0.1}, {0.5, 0, 0.1}));
}

// The same where slab and floor share the edge at the foot: neighbours, folded over one another.
TEST(Continuity, SlabFoldedOverTheFloorItJoinsIsTwoPieces) {
  Scene scene = emptyScene();
  addQuad(scene, {-1, 0, -5}, {-1, 0, 5}, {9, 0, 5}, {9, 0, -5});
  addQuad(scene, {-1, 0, -5}, {-1, 0, 5}, {0, 2, 5}, {0, 2, -5});
  for (const double z : {-2.0, 0.1, 2.0}) {
    EXPECT_FALSE(continuous(scene, {-0.05, 1.9, z}, {0.05, 0, z}));
    EXPECT_FALSE(continuous(scene, {-0.5, 1.0, z}, {0.5, 0, z}));
  }
}

// Rays that pass the tip of a pyramid nearer than the last stretch is wide: the two faces hit there share no
// edge, only the tip beside the rays. They are aimed at the tip's height, so that all lie in one plane.
TEST(Continuity, ArcPastTheTipOfAPyramidIsOnePiece) {
  Scene scene = emptyScene();
  const int faces = 7;
  const auto rim = [&](int i) {
    const double azimuth = 0.3 + 2.0 * std::numbers::pi * i / faces;
    return glm::dvec3(std::cos(azimuth), 0.0, std::sin(azimuth));
  };
  for (int i = 0; i < faces; ++i) addTriangle(scene, {0, 1, 0}, rim(i), rim(i + 1));
  const Tracer tracer(scene);
  for (int i = 0; i < 200; ++i) {
    const double past = 1e-6 * (i - 100);
    EXPECT_TRUE(continuous(tracer, {0.02, 1, past}, {-0.03, 1, past})) << past;
  }
}

// The wall of a floating box, seen steeply, then the floor: the wall's plane would reach the floor, the wall does not.
TEST(Continuity, WallOfAFloatingBoxIsTwoPiecesFromTheFloor) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 10.0);
  addBox(scene, {-2, 0.3, -2}, {0.1, 2, 2});
  EXPECT_TRUE(continuous(scene, {0.05, 2, 0.1}, {-0.9, 2, 0.2}));
  EXPECT_FALSE(continuous(scene, {0.09, 2, 0.1}, {0.3, 0, 0.1}));
  Scene open = emptyScene();
  addFloor(open, 0.0, 10.0);
  addQuad(open, {0.1, 2, -5}, {0.1, 2, 5}, {0.5, 0.05, 5}, {0.5, 0.05, -5});  // leans towards the light
  EXPECT_FALSE(continuous(open, {0.3, 1.025, 0.1}, {0.6, 0, 0.1}));
}

TEST(Continuity, SurfaceAndSkyAreTwoPiecesAndSkyIsOne) {
  Scene scene = emptyScene();
  addQuad(scene, {-5, 0, -5}, {-5, 0, 5}, {0, 0, 5}, {0, 0, -5});
  EXPECT_FALSE(continuous(scene, {-0.1, 0, 0.1}, {0.1, 0, 0.1}));
  EXPECT_TRUE(continuous(scene, {0.1, 0, 0.1}, {0.3, 0, 0.1}));
}

// A small silhouette beside a large crease: best first must not lose it.
TEST(Continuity, SmallStepBesideALargeCreaseIsFound) {
  Scene scene = emptyScene();
  addQuad(scene, {-5, 0, -5}, {-5, 0, 5}, {0, 0, 5}, {0, 0, -5});
  addQuad(scene, {0, 0.03, -5}, {0, 0.03, 5}, {1, 0.03, 5}, {1, 0.03, -5});
  addQuad(scene, {1, 0.03, -5}, {1, 0.03, 5}, {2, -4, 5}, {2, -4, -5});
  EXPECT_FALSE(continuous(scene, {-0.5, 0, 0.1}, {1.3, -1.18, 0.1}));
}

// The same among more facets than there are probes.
TEST(Continuity, SilhouetteBehindManyFacetsIsFound) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 10.0);
  addSphere(scene, {0, 2, 0}, 1.0, 300, 600);
  const Tracer tracer(scene);
  for (const double z : {0.0, 0.1, 0.37}) EXPECT_FALSE(continuous(tracer, {0.1, 2.9, z}, {2.5, 0, z})) << z;
}

TEST(Continuity, DirectionalRaysAreJudgedAlike) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 10.0);
  addBox(scene, {-2, 0, -2}, {-1, 1, 2});
  addQuad(scene, {1, 1, -2}, {2, 1, -2}, {2, 1, 2}, {1, 1, 2});
  const Tracer tracer(scene);
  const LightModel light = directionalLight({-0.4, -1, 0.1});
  const LightRays rays(scene, light);
  const auto between = [&](const glm::dvec3& a, const glm::dvec3& b) {
    return continuousBetween(tracer, rays.towards(a).ray, rays.towards(b).ray, endMargin(scene));
  };
  EXPECT_TRUE(between({-1.2, 1, 0.1}, {-0.9, 0, 0.1}));  // the box's lit side joins top and floor
  EXPECT_FALSE(between({1.2, 1, 0.1}, {0.4, 0, 0.1}));   // the plate's border does not
  EXPECT_TRUE(between({3.0, 0, 0.1}, {4.0, 0, -0.4}));
}

}  // namespace
}  // namespace gnomon::test
