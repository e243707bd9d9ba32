// Instances of a few shared meshes, from ten thousand to nineteen million triangles.

#include "base/check.h"
#include "scene/generate/compose.h"
#include "scene/generate/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {

namespace {

constexpr int kKinds = 3;

// A figure turned on a lathe and fluted: its outline is given by a few knots, refined to `rings` steps.
Mesh figureMesh(const char* name, int material, const std::vector<glm::dvec2>& knots, double fluting, int flutes,
                int segments, int rings) {
  MeshBuilder builder(name, material);
  const auto outline = [&](double t) {
    // Catmull-Rom through the knots.
    const double scaled = t * static_cast<double>(knots.size() - 1);
    const int last = static_cast<int>(knots.size()) - 1;
    const int i = std::min(static_cast<int>(scaled), last - 1);
    const double f = scaled - i;
    const glm::dvec2 p0 = knots[std::max(i - 1, 0)], p1 = knots[i], p2 = knots[i + 1],
                     p3 = knots[std::min(i + 2, last)];
    return 0.5 *
           (2.0 * p1 + f * (p2 - p0 + f * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + f * (3.0 * (p1 - p2) + p3 - p0))));
  };
  const auto onFigure = [&](double u, int j) {
    if (j == 0 || j == rings) return glm::dvec3(0.0, j == 0 ? knots.front().y : knots.back().y, 0.0);
    const glm::dvec2 p = outline(static_cast<double>(j) / rings);
    const double angle = 2.0 * std::numbers::pi * u;
    const double radius = std::max(p.x, 1e-3) * (1.0 + fluting * std::cos(flutes * angle + 1.5 * p.y));
    return glm::dvec3(radius * std::cos(angle), p.y, -radius * std::sin(angle));
  };
  const auto point = [&](int i, int j) { return onFigure(static_cast<double>(i) / segments, j); };
  const auto normal = [&](int i, int j) {
    if (j == 0 || j == rings) return glm::dvec3(0, j == 0 ? -1 : 1, 0);
    const double u = static_cast<double>(i) / segments, h = 1e-4;
    return glm::normalize(glm::cross(onFigure(u + h, j) - onFigure(u - h, j), point(i, j + 1) - point(i, j - 1)));
  };
  builder.loop(segments, rings, point, normal);
  return builder.build();
}

// Three figures of about `triangles` each: a statue, an obelisk and an urn, one to two metres high.
void addFigures(Scene& scene, double triangles) {
  const int bronze = addMaterial(scene, "bronze", {0.36f, 0.24f, 0.12f});
  const int granite = addMaterial(scene, "granite", {0.46f, 0.42f, 0.42f});
  const int glaze = addMaterial(scene, "blue glaze", {0.10f, 0.24f, 0.42f});
  const std::vector<glm::dvec2> statue = {{0.0, -0.02}, {0.34, -0.02}, {0.34, 0.14}, {0.22, 0.20},
                                          {0.26, 0.45}, {0.20, 0.85},  {0.25, 1.15}, {0.10, 1.33},
                                          {0.09, 1.40}, {0.15, 1.52},  {0.13, 1.66}, {0.0, 1.74}};
  const std::vector<glm::dvec2> obelisk = {{0.0, -0.02}, {0.36, -0.02}, {0.36, 0.20}, {0.24, 0.28},
                                           {0.21, 0.8},  {0.18, 1.4},   {0.14, 1.9},  {0.0, 2.15}};
  const std::vector<glm::dvec2> urn = {{0.0, -0.02}, {0.24, -0.02}, {0.22, 0.08}, {0.10, 0.20},
                                       {0.30, 0.55}, {0.38, 0.85},  {0.26, 1.05}, {0.15, 1.12},
                                       {0.24, 1.22}, {0.10, 1.20},  {0.0, 1.0}};
  // 2 * segments * (rings - 1) triangles, with three rings to two segments.
  const int segments = std::max(6, static_cast<int>(std::lround(std::sqrt(triangles / 3.0))));
  const int rings = std::max(6, static_cast<int>(std::lround(triangles / (2.0 * segments)))) + 1;
  scene.meshes.push_back(figureMesh("statue", bronze, statue, 0.10, 5, segments, rings));
  scene.meshes.push_back(figureMesh("obelisk", granite, obelisk, 0.06, 8, segments, rings));
  scene.meshes.push_back(figureMesh("urn", glaze, urn, 0.035, 12, segments, rings));
}

}  // namespace

Scene makeCrowd(uint64_t triangles) {
  GNOMON_CHECK_LE(kCrowdMin, triangles);
  GNOMON_CHECK_LE(triangles, kCrowdMax);
  Scene scene;
  scene.name = "crowd";
  const int ground = addMaterial(scene, "gravel", {0.50f, 0.46f, 0.40f}, true);
  const double wanted = static_cast<double>(triangles);
  // About 49 figures until each has 20,000 triangles, then more figures.
  addFigures(scene, std::clamp(wanted / 49.0, 200.0, 20000.0));
  const double each = static_cast<double>(scene.meshes[0].indices.size() / 3);
  const int count = static_cast<int>(std::lround((wanted - 2.0) / each));
  const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
  constexpr double kPitch = 1.15;  // metres
  for (int k = 0; k < count; ++k) {
    const uint32_t seed = static_cast<uint32_t>(k) * 4;
    const double x = k % columns - 0.5 * (columns - 1) + 0.35 * (hashUnit(seed) - 0.5);
    const double z = k / columns - 0.5 * (columns - 1) + 0.35 * (hashUnit(seed + 1) - 0.5);
    const double size = 0.8 + 0.35 * hashUnit(seed + 2);
    Instance instance;
    instance.name = "figure";
    instance.mesh = k < kKinds ? k : static_cast<int>(hashUnit(seed + 3) * kKinds);
    instance.worldFromMesh = glm::mat4(
        glm::scale(placed({kPitch * x, 0, kPitch * z}, {0, 1, 0}, 360.0 * hashUnit(seed + 3)), glm::dvec3(size)));
    scene.instances.push_back(std::move(instance));
  }
  const double half = 0.5 * kPitch * columns + 1.5;
  addMesh(scene, groundMesh("ground", ground, {-half, -half}, {half, half}));

  // The lamp hangs over the crowd, above the tallest figure (2.5 m).
  const float reach = static_cast<float>(half);
  addPointLight(scene, "lamp", {-0.25f * reach, 3.0f + 0.12f * reach, 0.2f * reach}, 1.6f * reach * reach + 25.0f);
  addDirectionalLight(scene, "sun", {0.6f, -0.7f, -0.35f}, 2.5f);
  addCamera(scene, "crowd", {0.55f * reach, 2.2f + 0.45f * reach, 1.35f * reach}, {-0.05f * reach, 0.6f, 0.1f * reach},
            50.0f);
  addCamera(scene, "among", {0.9f, 1.9f, 0.5f * reach + 1.0f}, {-0.4f, 1.0f, 0.0f}, 55.0f);
  return scene;
}

}  // namespace gnomon
