// Windows that hold still, near planes that miss nothing.
#include "planar/window.h"
#include "tests/shadow/map_fixture.h"

#include <cmath>
#include <set>

namespace gnomon {
namespace {

TEST(SnapWindow, CoversWhatItWasGiven) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 4096; ++i) {
    Window window;
    const double scale = std::pow(10.0, 4.0 * unit(random));
    for (int axis = 0; axis < 2; ++axis) {
      window.lower[axis] = scale * unit(random);
      window.upper[axis] = window.lower[axis] + scale * (0.01 + std::abs(unit(random)));
    }
    const Window snapped = snapWindow(window, 512);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_LE(snapped.lower[axis], window.lower[axis]);
      EXPECT_GE(snapped.upper[axis], window.upper[axis]);
      const double lost = (snapped.upper[axis] - snapped.lower[axis]) / (window.upper[axis] - window.lower[axis]);
      EXPECT_LE(lost, kTexelSizeStep * 512.0 / 511.0 + 1e-9);
    }
  }
}

TEST(SnapWindow, HoldsStillWhenTheWindowMovesWithinATexel) {
  const Window window{.lower = {0.1, -0.7}, .upper = {1.3, 0.4}};
  const glm::dvec2 texel = (snapWindow(window, 256).upper - snapWindow(window, 256).lower) / 256.0;
  std::set<double> corners;
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec2 by = texel * (static_cast<double>(i) / kSteps);
    const Window moved = snapWindow({.lower = window.lower + by, .upper = window.upper + by}, 256);
    corners.insert(moved.lower.x);
    for (int axis = 0; axis < 2; ++axis) {
      const double texels = moved.lower[axis] / texel[axis];
      EXPECT_NEAR(texels, std::round(texels), 1e-6);  // a grid that does not know the window
    }
  }
  EXPECT_LE(corners.size(), size_t{2});  // one step where the window crosses a texel
}

// Brute force: the nearest of many points sampled on every triangle within the window is never nearer than
// the answer, and comes close to it.
TEST(NearestCasterDepth, IsTheNearestPointOfAnyTriangleInTheWindow) {
  const Scene scene = findGeneratedScene("contact")->make();
  const Bounds bounds = computeBounds(scene);
  const Window window{.lower = {-0.3, -0.25}, .upper = {0.35, 0.4}};
  for (const bool perspective : {true, false}) {
    const glm::dvec3 eye =
        glm::dvec3(bounds.center()) + glm::dvec3(0.6, 1.0, 0.4) * static_cast<double>(bounds.diagonal());
    const AxisFrame frame = axisFrame(eye, glm::dvec3(bounds.center()) - eye, perspective);
    const double depth = nearestCasterDepth(scene, frame, clipFromPlane(window), 1e-3, 1e9);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    double nearest = 1e9;
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[instance.mesh];
      const glm::dmat4 m(instance.worldFromMesh);
      for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        glm::dvec3 c[3];
        for (size_t k = 0; k < 3; ++k) c[k] = glm::dvec3(m * glm::dvec4(mesh.positions[mesh.indices[t + k]], 1.0));
        for (int i = 0; i < 400; ++i) {
          const double u = std::sqrt(unit(random)), v = unit(random);
          const glm::dvec3 p = frame.planeFromWorld(c[0] * (1 - u) + c[1] * u * (1 - v) + c[2] * u * v);
          if (p.x > window.lower.x && p.x < window.upper.x && p.y > window.lower.y && p.y < window.upper.y && p.z > 0)
            nearest = std::min(nearest, p.z);
        }
      }
    }
    EXPECT_LE(depth, nearest);
    EXPECT_GT(depth, 0.97 * nearest);
  }
}

TEST(NearestCasterDepth, ATriangleThatSurroundsTheLightIsCutAtTheLeastDepth) {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  mesh.positions = {{-10, 0.1f, -10}, {10, 0.1f, -10}, {0, 0.1f, 10}};
  mesh.normals.assign(3, {0, 1, 0});
  mesh.uvs.assign(3, {0, 0});
  mesh.indices = {0, 1, 2};
  scene.meshes.push_back(mesh);
  scene.instances.emplace_back();
  // The light looks along -z from the origin; the triangle passes 0.1 above it and fills the upper half of the view.
  const AxisFrame frame = axisFrame({0, 0, 0}, {0, 0, -1}, true);
  const double depth =
      nearestCasterDepth(scene, frame, clipFromPlane({.lower = {-1, -1}, .upper = {1, 1}}), 1e-4, 100.0);
  EXPECT_NEAR(depth, 0.1, 1e-6);  // where y / depth = 1
}

TEST(Fit, EveryReceiverIsCoveredAndBetweenNearAndFar) {
  for (const char* name : {"contact", "corner", "tilted-planes"}) {
    const Scene scene = findGeneratedScene(name)->make();
    const Bounds bounds = computeBounds(scene);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    std::vector<glm::dvec3> receivers;
    for (int i = 0; i < 500; ++i)
      receivers.emplace_back(glm::mix(bounds.lower, bounds.upper, glm::vec3(unit(random), unit(random), unit(random))));
    const glsl::CameraView camera = cameraView(scene.cameras.front(), 64, 64);
    for (const Parameterization* map : planarParameterizations()) {
      const glm::dvec3 eye = glm::dvec3(bounds.center()) + glm::dvec3(0, 2.0 * bounds.diagonal(), 0.1);
      Light light;
      light.positionW = glm::vec3(eye);
      const LightModel model = map->lightModel(light, glm::normalize(glm::dvec3(bounds.center()) - eye));
      const FittedMap fitted =
          map->fit({.scene = scene, .light = model, .receiversW = receivers, .side = 64, .camera = camera});
      for (const glm::dvec3& receiver : receivers) {
        const glm::vec3 posL = glsl::lightFromWorld(fitted.frame, glm::vec3(receiver));
        EXPECT_TRUE(glsl::mapProject(fitted.map, posL).covered) << name << " " << map->name();
        EXPECT_LT(glsl::mapDepth(fitted.map, 0, posL), 1.0f);
      }
    }
  }
}

}  // namespace
}  // namespace gnomon
