// The tracer against paper and against a loop over all triangles in double.

#include "scenes_by_hand.h"

#include "base/error.h"
#include "truth/triangle.h"
#include "truth/visibility.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::test {
namespace {

RayD rayBetween(const glm::dvec3& from, const glm::dvec3& to) {
  return {from, glm::normalize(to - from)};
}

// From a light to a point on `own`, as computeTruth asks.
struct Asked {
  RayD ray;
  double distance;
  Primitive own;
  glm::dvec3 normal;
};

Asked askPoint(const Tracer& tracer, const glm::dvec3& lightW, const Primitive& own, const glm::dvec3& weights) {
  glm::dvec3 at[3];
  tracer.corners(own, at);
  const glm::dvec3 point = at[0] * weights.x + at[1] * weights.y + at[2] * weights.z;
  glm::dvec3 normal = triangleNormal(at);
  if (glm::dot(normal, lightW - point) < 0.0) normal = -normal;
  return {rayBetween(lightW, point), glm::length(point - lightW), own, normal};
}

bool occluded(const Tracer& tracer, const Asked& asked, double margin) {
  return tracer.occluded(asked.ray, asked.distance, asked.own, asked.normal, margin);
}

TEST(FirstHit, DistanceHasDoublePrecision) {
  Scene scene = emptyScene();
  addFloor(scene, 0.25, 1000.0);
  const Tracer tracer(scene);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-500.0, 500.0);
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 eye(coordinate(random), 1.0 + std::abs(coordinate(random)), coordinate(random));
    const glm::dvec3 target(coordinate(random), 0.25, coordinate(random));
    const std::optional<SurfaceHit> hit = tracer.firstHit(rayBetween(eye, target));
    ASSERT_TRUE(hit.has_value());
    worst = std::max(worst, std::abs(hit->distance / glm::length(target - eye) - 1.0));
    EXPECT_EQ(hit->normalW, glm::dvec3(0, 1, 0));
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(FirstHit, MissesWhatIsNotThere) {
  Scene scene = emptyScene();
  const Tracer nothing(scene);
  EXPECT_FALSE(nothing.firstHit({{0, 0, 0}, {0, 0, 1}}).has_value());
  addFloor(scene, 0.0, 1.0);
  const Tracer tracer(scene);
  EXPECT_FALSE(tracer.firstHit({{0, 1, 0}, {0, 1, 0}}).has_value());
  EXPECT_FALSE(tracer.firstHit({{2, 1, 0}, {0, -1, 0}}).has_value());
}

TEST(AlphaMask, HoleLetsLightThroughAndTheRestBlocks) {
  Scene scene = emptyScene();
  const int floor = addFloor(scene, 0.0, 4.0);
  const int leaf = addQuad(scene, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});  // uv (0,0) at (-1,-1)
  scene.meshes[static_cast<size_t>(leaf)].material = addMaskMaterial(scene);
  const Tracer tracer(scene);
  for (const bool hole : {true, false}) {
    const glm::dvec3 through(hole ? -0.5 : 0.5, 1.0, -0.4);
    const glm::dvec3 light(through.x, 3.0, -0.4);
    const std::optional<SurfaceHit> hit = tracer.firstHit(rayBetween(light, through));
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->primitive.instance, static_cast<uint32_t>(hole ? floor : leaf));
    EXPECT_NEAR(hit->distance, hole ? 3.0 : 2.0, 1e-12);
    const glm::dvec3 below(through.x, 0.0, -0.4);
    const Primitive own{static_cast<uint32_t>(floor), 0};
    EXPECT_EQ(tracer.occluded(rayBetween(light, below), 3.0, own, {0, 1, 0}, 1e-5), !hole);
  }
}

TEST(AlphaMask, HolesOfInstancesAreHolesToo) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 9.0);
  const int leaf = addQuad(scene, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
  const int mesh = scene.instances[static_cast<size_t>(leaf)].mesh;
  scene.meshes[static_cast<size_t>(mesh)].material = addMaskMaterial(scene);
  addInstance(scene, mesh, glm::translate(glm::mat4(1.0f), {3.0f, 0.0f, 0.0f}));
  const Tracer tracer(scene);
  const auto blocked = [&](double x, double z) {
    return tracer.occluded({{x, 3, z}, {0, -1, 0}}, 3.0, {0, 0}, {0, 1, 0}, 1e-5);
  };
  EXPECT_FALSE(blocked(-0.5, -0.5));
  EXPECT_TRUE(blocked(0.5, -0.5));
  EXPECT_FALSE(blocked(2.5, -0.5));
  EXPECT_TRUE(blocked(3.5, 0.5));
}

// Where the triangle is, how it is turned, and where the light hangs, all at random.
class OwnAndCoplanar : public testing::TestWithParam<double> {};

TEST_P(OwnAndCoplanar, NeverBlock) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  size_t asked = 0, blocked = 0;
  for (int turn = 0; turn < 60; ++turn) {
    Scene scene = emptyScene();
    // The same quad three times: as it is, cut along its other diagonal, and cut into a fan about its middle.
    const glm::dvec3 a(-1, 0, -1), b(1.3, 0, -1.1), c(1.2, 0, 0.9), d(-0.8, 0, 1);
    const glm::dvec3 middle = 0.25 * (a + b + c + d);
    addQuad(scene, a, b, c, d);
    addQuad(scene, b, c, d, a);
    for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}}) addTriangle(scene, p, q, middle);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random) + 1.5));
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 3.0 * unit(random), axis);
    const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), GetParam() * glm::dvec3(1, 0.7, -0.9)) * turned;
    moveAll(scene, moved);
    const Tracer tracer(scene);
    const double margin = endMargin(scene);
    for (int i = 0; i < 500; ++i) {
      const double lowest = i % 2 == 0 ? 0.5 : 0.02;  // half of the lights graze
      const glm::dvec3 lightW(moved *
                              glm::dvec4(3.0 * unit(random), lowest + std::abs(unit(random)), 3.0 * unit(random), 1));
      const Primitive own{static_cast<uint32_t>(i % 6), 0};
      const double u = 0.5 + 0.5 * unit(random), v = (1.0 - u) * (0.5 + 0.5 * unit(random));
      ++asked;
      blocked += occluded(tracer, askPoint(tracer, lightW, own, {1.0 - u - v, u, v}), margin) ? 1 : 0;
    }
  }
  EXPECT_EQ(blocked, 0u) << "of " << asked;
}

INSTANTIATE_TEST_SUITE_P(MetresFromTheOrigin, OwnAndCoplanar, testing::Values(0.0, 10.0, 1000.0));

// --- Brute force ---------------------------------------------------------------------------------------

// What a loop in double says, and how near any of its decisions was to going the other way, in metres.
struct Brute {
  bool blocked = false;
  double closest = 1e9;
};

Brute bruteForce(const Tracer& tracer, const Scene& scene, const Asked& asked, double margin) {
  Brute result;
  const glm::dvec3 point = asked.ray.origin + asked.ray.dir * asked.distance;
  for (uint32_t instance = 0; instance < scene.instances.size(); ++instance) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(scene.instances[instance].mesh)];
    for (uint32_t triangle = 0; triangle < mesh.indices.size() / 3; ++triangle) {
      const Primitive primitive{instance, triangle};
      if (primitive == asked.own) continue;
      glm::dvec3 at[3];
      tracer.corners(primitive, at);
      // Signed distances from the line to the edges: positive on one side all round where it passes through.
      double least = 1e9, most = -1e9;
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 p = at[k] - asked.ray.origin, q = at[(k + 1) % 3] - asked.ray.origin;
        const glm::dvec3 side = glm::cross(p, q);
        const double across = glm::length(glm::cross(q - p, asked.ray.dir));
        const double distance = across > 0.0 ? glm::dot(side, asked.ray.dir) / across : 0.0;
        least = std::min(least, distance);
        most = std::max(most, distance);
      }
      const bool through = least > 0.0 || most < 0.0;
      const double fromEdge = least > 0.0 ? least : most < 0.0 ? -most : std::min(-least, most);
      const glm::dvec3 normal = triangleNormal(at);
      const double approach = glm::dot(normal, asked.ray.dir);
      if (approach == 0.0) continue;
      const double t = glm::dot(normal, at[0] - asked.ray.origin) / approach;
      const double height = glm::dot(asked.normal, asked.ray.origin + asked.ray.dir * t - point);
      const bool inFront = t > 0.0 && height > margin;
      if (through && inFront) result.blocked = true;
      if (through || fromEdge < 1e-3) {
        const double undecided = std::min(std::abs(t), std::abs(height - margin));
        result.closest = std::min(result.closest, through && inFront ? std::min(fromEdge, undecided)
                                                  : through          ? undecided
                                                  : inFront          ? fromEdge
                                                                     : std::max(fromEdge, undecided));
      }
    }
  }
  return result;
}

Scene makeSoup(bool instanced, double offset) {
  std::mt19937 random(instanced ? 5 : 3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto point = [&](double scale) { return scale * glm::dvec3(unit(random), unit(random), unit(random)); };
  Scene scene = emptyScene();
  const int meshes = instanced ? 4 : 40;
  for (int m = 0; m < meshes; ++m) {
    const glm::dvec3 center = point(2.0) + glm::dvec3(instanced ? 0.0 : offset);
    std::vector<glm::dvec3> corners;
    for (int k = 0; k < 3; ++k) corners.push_back(center + point(0.8));
    const int added = addTriangle(scene, corners[0], corners[1], corners[2]);
    if (!instanced) continue;
    const int mesh = scene.instances[static_cast<size_t>(added)].mesh;
    for (int i = 0; i < 10; ++i) {
      const glm::dvec3 axis = glm::normalize(point(1.0));
      glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), point(1.5) + glm::dvec3(offset)) *
                          glm::rotate(glm::dmat4(1.0), 3.0 * unit(random), axis);
      matrix = glm::scale(matrix, {1.0 + 0.5 * unit(random), i % 2 == 0 ? -1.0 : 1.0, 0.7});
      addInstance(scene, mesh, glm::mat4(matrix));
    }
  }
  return scene;
}

struct Soup {
  bool instanced;
  double offset;  // metres from the origin, along each axis
};

class BruteForce : public testing::TestWithParam<Soup> {};

// 10^5 segments. Only those may differ that pass an edge, or end at the margin, nearer than the float ray can
// tell: 2^-22 of the largest coordinate and of the ray's length, of the order of one ulp.
TEST_P(BruteForce, AgreesWithALoopInDouble) {
  const Scene scene = makeSoup(GetParam().instanced, GetParam().offset);
  const Tracer tracer(scene);
  const double margin = endMargin(scene);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double bound = 0x1p-22 * (GetParam().offset + 8.0) * (GetParam().instanced ? 8.0 : 1.0);
  size_t differing = 0, beyond = 0, blocked = 0;
  for (int i = 0; i < 100000; ++i) {
    const glm::dvec3 lightW(
        glm::vec3(glm::dvec3(GetParam().offset) + 4.0 * glm::dvec3(unit(random), unit(random), unit(random))));
    const Primitive own{static_cast<uint32_t>(random() % scene.instances.size()), 0};
    const double u = 0.5 + 0.5 * unit(random), v = (1.0 - u) * (0.5 + 0.5 * unit(random));
    const Asked asked = askPoint(tracer, lightW, own, {1.0 - u - v, u, v});
    const Brute brute = bruteForce(tracer, scene, asked, margin);
    blocked += brute.blocked ? 1 : 0;
    if (occluded(tracer, asked, margin) == brute.blocked) continue;
    ++differing;
    beyond += brute.closest > bound ? 1 : 0;
  }
  EXPECT_EQ(beyond, 0u) << differing << " differ";
  EXPECT_LE(differing, 20u);
  EXPECT_GT(blocked, 10000u);
}

INSTANTIATE_TEST_SUITE_P(Soups, BruteForce,
                         testing::Values(Soup{false, 0.0}, Soup{true, 0.0}, Soup{false, 1000.0}, Soup{true, 100.0}));

TEST(Packets, SayWhatSingleRaysSay) {
  const Scene scene = makeSoup(true, 0.0);
  const Tracer tracer(scene);
  std::mt19937 random(13);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double margin = 0.05;  // large, so that many blockers lie about it
  std::vector<ShadowSegment> segments;
  for (int i = 0; i < 20003; ++i) {
    const glm::dvec3 lightW = 4.0 * glm::dvec3(unit(random), unit(random), unit(random));
    const Primitive own{static_cast<uint32_t>(random() % scene.instances.size()), 0};
    const Asked asked = askPoint(tracer, lightW, own, {0.3, 0.3, 0.4});
    segments.push_back({asked.ray, asked.distance, asked.own, asked.normal});
  }
  std::vector<double> heights(segments.size());
  tracer.blockerHeights(segments, 2.0 * margin, heights);
  size_t differing = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    const ShadowSegment& s = segments[i];
    for (const double m : {0.5 * margin, margin, 2.0 * margin}) {
      differing += tracer.occluded(s.ray, s.distance, s.own, s.planeNormal, m) != (heights[i] > m) ? 1 : 0;
    }
  }
  EXPECT_EQ(differing, 0u);
}

TEST(Instances, SqueezedFlatStillBlock) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 5.0);
  const int box = addBox(scene, {-0.5, 0.5, -0.5}, {0.5, 1.5, 0.5});
  const int mesh = scene.instances[static_cast<size_t>(box)].mesh;
  const glm::mat4 flat =
      glm::translate(glm::mat4(1.0f), {2.5f, 1.0f, 0.0f}) * glm::scale(glm::mat4(1.0f), {1.0f, 0.0f, 1.0f});
  addInstance(scene, mesh, flat);
  const Tracer tracer(scene);
  const std::optional<SurfaceHit> hit = tracer.firstHit({{2.4, 3, 0.1}, {0, -1, 0}});
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->distance, 2.0, 1e-6);
  EXPECT_TRUE(tracer.occluded({{2.4, 3, 0.1}, {0, -1, 0}}, 3.0, {0, 0}, {0, 1, 0}, 1e-5));
}

// The quad's border is at x = 0; a float ray that started at the light, a thousand kilometres off, would stray by 3 cm.
TEST(FarLight, StillSeesTheSceneInFullPrecision) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 1.0);
  addQuad(scene, {-0.5, 0.5, -0.5}, {0, 0.5, -0.5}, {0, 0.5, 0.5}, {-0.5, 0.5, 0.5});
  const Tracer tracer(scene);
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, 1.0, -0.2));
  for (const double x : {-1e-4, -1e-5, 1e-5, 1e-4}) {
    const glm::dvec3 q(x, 0.5, 0.1);
    const glm::dvec3 p = q - up * (0.5 / up.y);
    const glm::dvec3 lightW = q + up * 1e6;
    EXPECT_EQ(tracer.occluded(rayBetween(lightW, p), glm::length(p - lightW), {0, 0}, {0, 1, 0}, 1e-6), x < 0.0) << x;
    const std::optional<SurfaceHit> hit = tracer.firstHit(rayBetween(lightW, p));
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->primitive.instance, x < 0.0 ? 1u : 0u);
  }
}

// At no margin at all, what keeps a triangle from blocking itself is its name.
TEST(Own, NeverBlocksEvenWithoutAMargin) {
  Scene scene = emptyScene();
  addTriangle(scene, {-1.1, 0.3, -1.2}, {1.7, 0.9, 0.1}, {-0.4, -0.6, 1.3});
  const Tracer tracer(scene);
  std::mt19937 random(29);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  size_t blocked = 0;
  for (int i = 0; i < 20000; ++i) {
    const double u = 0.5 + 0.5 * unit(random), v = (1.0 - u) * (0.5 + 0.5 * unit(random));
    const glm::dvec3 lightW = 5.0 * glm::dvec3(unit(random), unit(random), unit(random));
    blocked += occluded(tracer, askPoint(tracer, lightW, {0, 0}, {1.0 - u - v, u, v}), 0.0) ? 1 : 0;
  }
  EXPECT_EQ(blocked, 0u);
}

TEST(TracerDeathTest, RefusesAPrimitiveThatIsNotThere) {
  Scene scene = emptyScene();
  addFloor(scene, 0.0, 1.0);
  const Tracer tracer(scene);
  glm::dvec3 at[3];
  EXPECT_DEATH(tracer.corners({0, 2}, at), "2 against 2");
  EXPECT_DEATH(tracer.corners({1, 0}, at), "1 against 1");
}

}  // namespace
}  // namespace gnomon::test
