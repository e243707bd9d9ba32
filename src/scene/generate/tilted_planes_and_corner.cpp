// Two scenes with analytic answers: planes at every angle to the light, and a concave corner.

#include "scene/generate/compose.h"
#include "scene/generate/scenes.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

// Each tile is turned about its own centre until its normal makes the stated angle with the direction to the light,
// towards the camera, which stands about 60 degrees off: so the camera sees the lit side of every tile.
//
//   light *            normal = cos(angle) toLight + sin(angle) aside,
//          \  . n      aside = toEye made perpendicular to toLight
//           \/____ eye
//
// cos(angle) at any other point of the tile is (distance of the light from the plane) / (distance of the light from the
// point), so a tile faces the light everywhere or nowhere: the last, at 88.5 degrees, still faces it.
Scene makeTiltedPlanes() {
  Scene scene;
  scene.name = "tilted-planes";
  const glm::dvec3 lightW(-4.6, 4.6, 3.4), eyeW(0.0, 0.0, 8.5);
  constexpr std::array<double, 16> kAngles = {0, 10, 20, 30, 40, 50, 60, 66, 70, 74, 78, 81, 83, 85, 87, 88.5};
  constexpr double kHalf = 0.42, kPitch = 1.5;  // metres
  for (size_t k = 0; k < kAngles.size(); ++k) {
    const double x = static_cast<double>(k % 4) - 1.5, y = 1.5 - static_cast<double>(k / 4);
    const glm::dvec3 center(kPitch * x, kPitch * y, 0.0);
    const glm::dvec3 toLight = glm::normalize(lightW - center), toEye = glm::normalize(eyeW - center);
    const glm::dvec3 aside = glm::normalize(toEye - glm::dot(toEye, toLight) * toLight);
    const double angle = glm::radians(kAngles[k]);
    const glm::dvec3 normal = std::cos(angle) * toLight + std::sin(angle) * aside;
    const glm::dvec3 right = kHalf * glm::normalize(glm::cross(glm::dvec3(0, 1, 0), normal));
    const glm::dvec3 up = kHalf * glm::normalize(glm::cross(normal, right));
    const float t = static_cast<float>(k) / (kAngles.size() - 1);
    const int material = addMaterial(scene, fmt::format("tile {}", kAngles[k]),
                                     glm::mix(glm::vec3(0.75f, 0.72f, 0.62f), glm::vec3(0.62f, 0.30f, 0.20f), t), true);
    MeshBuilder builder(fmt::format("tile {} degrees", kAngles[k]), material);
    builder.quad(center - right - up, center + right - up, center + right + up, center - right + up);
    addMesh(scene, builder.build());
  }
  addPointLight(scene, "lamp", glm::vec3(lightW), 110.0f);
  addDirectionalLight(scene, "sun", glm::vec3(-lightW), 2.0f);
  addCamera(scene, "tiles", glm::vec3(eyeW), glm::vec3(0.0f), 42.0f);
  return scene;
}

// Two walls and a floor, three squares of two triangles each that share their edges: nothing casts a shadow,
// so every dark pixel that faces the light is acne.
Scene makeCorner() {
  Scene scene;
  scene.name = "corner";
  const int plaster = addMaterial(scene, "plaster", {0.70f, 0.66f, 0.58f}, true);
  constexpr double kSide = 4.0;  // metres
  MeshBuilder builder("corner", plaster);
  builder.quad({0, 0, kSide}, {kSide, 0, kSide}, {kSide, 0, 0}, {0, 0, 0});
  builder.quad({0, 0, kSide}, {0, 0, 0}, {0, kSide, 0}, {0, kSide, kSide});
  builder.quad({0, 0, 0}, {kSide, 0, 0}, {kSide, kSide, 0}, {0, kSide, 0});
  addMesh(scene, builder.build());
  addPointLight(scene, "lamp", {0.9f, 1.3f, 0.7f}, 4.5f);
  addDirectionalLight(scene, "sun", {-0.55f, -0.70f, -0.45f}, 2.0f);
  addCamera(scene, "room", {5.2f, 3.4f, 5.8f}, {1.1f, 1.0f, 1.1f}, 45.0f);
  addCamera(scene, "crease", {2.2f, 1.7f, 2.4f}, {0.0f, 0.35f, 0.0f}, 50.0f);
  return scene;
}

}  // namespace gnomon
