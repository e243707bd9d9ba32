// A light in a surface is found, wherever the surface's instance stands, and one beside it is not.
#include "judge/light_place.h"

#include "scene/generate.h"

#include <ctime>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {
namespace {

Light lightAt(const glm::vec3& positionW) {
  Light light;
  light.positionW = positionW;
  return light;
}

// Two unit squares in one mesh, turned, stretched and moved.
Scene sceneOfSquares() {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  mesh.name = "square";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs.assign(4, {0, 0});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(mesh);
  Instance near, far;
  near.name = "near";
  near.worldFromMesh = glm::rotate(glm::mat4(1.0f), 0.7f, glm::vec3(1, 2, 3));
  far.name = "far";
  far.worldFromMesh = glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(20, -3, 5)), glm::vec3(4, 0.5f, 2));
  scene.instances = {near, far};
  return scene;
}

TEST(LightPlaces, FindTheSurfaceThatHoldsALight) {
  Scene scene = sceneOfSquares();
  const auto placeOn = [&](size_t instance, const glm::vec3& inMesh) {
    return glm::vec3(scene.instances[instance].worldFromMesh * glm::vec4(inMesh, 1.0f));
  };
  const LightPlaces places(scene);
  for (const size_t instance : {0u, 1u}) {
    const std::string& name = scene.instances[instance].name;
    for (const glm::vec2 uv : {glm::vec2(0.3f, 0.6f), glm::vec2(0.9f, 0.1f), glm::vec2(0.0f, 0.0f), glm::vec2(1, 1)})
      EXPECT_EQ(places.surfaceThrough(lightAt(placeOn(instance, glm::vec3(uv, 0.0f)))), name) << uv.x << " " << uv.y;
    EXPECT_EQ(places.surfaceThrough(lightAt(placeOn(instance, {0.5f, 0.5f, 0.01f}))), std::nullopt);
    EXPECT_EQ(places.surfaceThrough(lightAt(placeOn(instance, {1.01f, 0.5f, 0.0f}))), std::nullopt);
  }
  Light sun = lightAt(placeOn(0, {0.5f, 0.5f, 0.0f}));
  sun.type = LightType::Directional;
  EXPECT_EQ(places.surfaceThrough(sun), std::nullopt);
  scene.instances[0].casts = false;  // it darkens nothing
  EXPECT_EQ(LightPlaces(scene).surfaceThrough(lightAt(placeOn(0, {0.5f, 0.5f, 0.0f}))), std::nullopt);
}

// Of a scene of a million triangles a light asks for those nearby: as much time as a hundred lights in a small one.
TEST(LightPlaces, DoNotReadEveryTriangleForEveryLight) {
  const Scene scene = openScene("crowd:1000000");
  const LightPlaces places(scene);
  const Bounds bounds = computeBounds(scene);
  const std::clock_t begin = std::clock();
  for (int i = 0; i < 100; ++i)
    places.surfaceThrough(lightAt(glm::mix(bounds.lower, bounds.upper, glm::vec3(0.01f * static_cast<float>(i)))));
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_LT(seconds, 10.0);  // all triangles for each take minutes
}

}  // namespace
}  // namespace gnomon
