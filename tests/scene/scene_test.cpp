#include "scene/scene.h"

#include "scene/mesh_builder.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

Mesh boxMesh() {
  MeshBuilder builder("box", 0);
  builder.box({-1, -1, -1}, {1, 1, 1});
  return builder.build();
}

TEST(Closed, boxIsClosedThoughItsFacesShareNoVertices) {
  EXPECT_TRUE(computeClosed(boxMesh()));
}

TEST(Closed, boxWithoutATriangleIsOpen) {
  Mesh mesh = boxMesh();
  mesh.indices.resize(mesh.indices.size() - 3);
  EXPECT_FALSE(computeClosed(mesh));
}

TEST(Closed, boxWithATurnedTriangleIsOpen) {
  Mesh mesh = boxMesh();
  std::swap(mesh.indices[0], mesh.indices[1]);
  EXPECT_FALSE(computeClosed(mesh));
}

TEST(Closed, boxWithADoubledTriangleIsOpen) {
  Mesh mesh = boxMesh();
  for (int k = 0; k < 3; ++k) mesh.indices.push_back(mesh.indices[k]);
  EXPECT_FALSE(computeClosed(mesh));
}

TEST(Closed, degenerateTrianglesArePassedOver) {
  Mesh mesh = boxMesh();
  for (uint32_t k : {0u, 1u, 1u}) mesh.indices.push_back(mesh.indices[k]);
  EXPECT_TRUE(computeClosed(mesh));
}

TEST(Closed, nothingIsNotClosed) {
  EXPECT_FALSE(computeClosed(Mesh{}));
}

TEST(Closed, minusZeroWeldsToZero) {
  Mesh mesh = boxMesh();
  for (glm::vec3& position : mesh.positions) position.x += 1.0f;
  size_t zeros = 0;
  for (glm::vec3& position : mesh.positions) {
    if (position.x != 0.0f) continue;
    position.x = zeros % 2 == 1 ? -0.0f : 0.0f;
    ++zeros;
  }
  EXPECT_GE(zeros, 4u);
  EXPECT_TRUE(computeClosed(mesh));
}

TEST(Solid, doubleSidedMaterialMakesASheetOfAClosedMesh) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].doubleSided = true;
  Mesh mesh = boxMesh();
  EXPECT_TRUE(isSolid(scene, mesh));
  mesh.material = 1;
  EXPECT_FALSE(isSolid(scene, mesh));
}

// Every shape of the builder that encloses something: closed, its normals outward, and of the volume it must have.
struct Shape {
  const char* name;
  double volume;
  double tolerance;  // of the volume: a polygon of n sides is smaller than its circle
  size_t triangles;
  void (*build)(MeshBuilder&);
};

class BuilderShapes : public testing::TestWithParam<Shape> {};

TEST_P(BuilderShapes, isClosedOutwardAndOfItsVolume) {
  const Shape& shape = GetParam();
  MeshBuilder builder(shape.name, 0);
  shape.build(builder);
  const Mesh mesh = builder.build();
  EXPECT_TRUE(mesh.closed);
  EXPECT_EQ(mesh.indices.size() / 3, shape.triangles);
  double volume = 0.0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
        c(mesh.positions[mesh.indices[i + 2]]);
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    const glm::dvec3 face = glm::cross(b - a, c - a);
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 normal(mesh.normals[mesh.indices[i + k]]);
      EXPECT_NEAR(glm::length(normal), 1.0, 1e-6);
      EXPECT_GT(glm::dot(face, normal), 0.0) << shape.name << ", triangle " << i / 3;
    }
  }
  EXPECT_NEAR(volume, shape.volume, shape.tolerance * shape.volume);
}

constexpr double kPi = std::numbers::pi;

INSTANTIATE_TEST_SUITE_P(
    All, BuilderShapes,
    testing::Values(Shape{"box", 8.0, 1e-6, 12,
                          [](MeshBuilder& b) {
                            b.box({-1, -1, -1}, {1, 1, 1});
                          }},
                    Shape{"sphere", 4.0 / 3.0 * kPi, 0.02, 64 * 31 * 2,
                          [](MeshBuilder& b) {
                            b.sphere({0.3, 0.2, 0.1}, 1.0, 64, 32);
                          }},
                    Shape{"torus", 2.0 * kPi* kPi * 0.09, 0.02, 64 * 32 * 2,
                          [](MeshBuilder& b) {
                            b.torus({0, 0, 0}, 1.0, 0.3, 64, 32);
                          }},
                    Shape{"cone", kPi / 3.0, 0.01, 64 + 62,
                          [](MeshBuilder& b) {
                            const glm::dvec2 profile[] = {{1, 0}, {0, 1}};
                            b.lathe(profile, 64);
                          }},
                    Shape{"cylinder", 2.0 * kPi * 0.25, 0.01, 4 * 64 - 4,
                          [](MeshBuilder& b) {
                            b.cylinder({0, -1, 0.2}, {0, 1, 0.2}, 0.5, 64);
                          }},
                    Shape{"tube", kPi * 0.01 * 2.0, 0.03, 2 * 32 * 2 + 2 * 30,
                          [](MeshBuilder& b) {
                            const glm::dvec3 path[] = {{0, 0, 0}, {1, 0, 0}, {1.99, 0.1, 0.1}};
                            b.tube(path, 0.1, 32);
                          }},
                    Shape{"concave extrusion", 3.0 * 2.0, 1e-6, 6 * 4 - 4,
                          [](MeshBuilder& b) {
                            const glm::dvec2 outline[] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
                            b.extrude(outline, -1.0, 1.0);
                          }}),
    [](const testing::TestParamInfo<Shape>& each) {
      std::string name = each.param.name;
      for (char& c : name) c = c == ' ' ? '_' : c;
      return name;
    });

TEST(BaseColor, factorTimesNearestTexelDecodedFromSrgb) {
  Scene scene;
  scene.texels = {0x80ff0000u, 0xff0000ffu, 0x40808080u, 0x00ffffffu};  // A B G R
  scene.textures.push_back({0, 2, 2, glsl::kWrapRepeat, glsl::kWrapRepeat, glsl::kTexFilterNearest});
  Material material;
  material.baseColor = glm::vec4(0.5f, 1.0f, 1.0f, 0.5f);
  material.baseColorTexture = 0;
  const glm::vec4 blue = baseColorAt(scene, material, glm::vec2(0.25f, 0.25f));
  EXPECT_FLOAT_EQ(blue.z, 1.0f);
  EXPECT_FLOAT_EQ(blue.x, 0.0f);
  EXPECT_FLOAT_EQ(blue.w, 0.5f * 128.0f / 255.0f);
  const glm::vec4 red = baseColorAt(scene, material, glm::vec2(0.75f, 0.25f));
  EXPECT_FLOAT_EQ(red.x, 0.5f);
  const glm::vec4 grey = baseColorAt(scene, material, glm::vec2(0.25f, 0.75f));
  EXPECT_NEAR(grey.y, 0.2158605f, 1e-6f);  // IEC 61966-2-1 of 128/255
}

TEST(BaseColor, alphaIsLinearBetweenTexelsSoTheCutoffFallsWhereItMust) {
  Scene scene;
  scene.texels = {0x00ffffffu, 0xffffffffu};
  scene.textures.push_back({0, 2, 1, glsl::kWrapClamp, glsl::kWrapClamp, glsl::kTexFilterLinear});
  Material material;
  material.baseColorTexture = 0;
  // Texel centres lie at u = 1/4 and 3/4; alpha rises linearly between them.
  for (float u : {0.0f, 0.25f, 0.3f, 0.5f, 0.6f, 0.75f, 1.0f}) {
    const float expected = std::clamp((u - 0.25f) * 2.0f, 0.0f, 1.0f);
    EXPECT_NEAR(baseColorAt(scene, material, glm::vec2(u, 0.5f)).w, expected, 1e-6f) << "u = " << u;
  }
}

TEST(LookAt, looksDownMinusZWithYUp) {
  const Camera camera = lookAt("c", {1, 2, 3}, {1, 2, -7}, 1.0f);
  EXPECT_EQ(camera.worldFromEye[3], glm::vec4(1, 2, 3, 1));
  EXPECT_EQ(camera.worldFromEye[2], glm::vec4(0, 0, 1, 0));
  EXPECT_EQ(camera.worldFromEye[1], glm::vec4(0, 1, 0, 0));
}

TEST(LookAt, vertical) {
  for (float y : {-5.0f, 5.0f}) {
    const glm::mat4 m = lookAt("c", {0, 0, 0}, {0, y, 0}, 1.0f).worldFromEye;
    EXPECT_EQ(m[2], glm::vec4(0, y > 0 ? -1 : 1, 0, 0));
    EXPECT_NEAR(glm::determinant(m), 1.0f, 1e-6f);
    EXPECT_EQ(m[1], glm::vec4(0, 0, 1, 0));
  }
}

TEST(Bounds, instancesAreMeasuredInTheWorld) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes.push_back(boxMesh());
  Instance instance;
  scene.instances.push_back(instance);
  instance.worldFromMesh[3] = glm::vec4(10, 0, 0, 1);
  scene.instances.push_back(instance);
  const Bounds bounds = computeBounds(scene);
  EXPECT_EQ(bounds.lower, glm::vec3(-1));
  EXPECT_EQ(bounds.upper, glm::vec3(11, 1, 1));
  EXPECT_FLOAT_EQ(bounds.diagonal(), std::sqrt(144.0f + 4.0f + 4.0f));
  EXPECT_EQ(triangleCount(scene), 24u);
}

}  // namespace
}  // namespace gnomon
