#include "scene/gltf.h"

#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "gltf_text.h"

#include "tests/base/places.h"

#include <cmath>
#include <ctime>
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::vector<glm::vec3> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<glm::vec3> kUp3 = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};

glm::vec3 faceNormal(const Mesh& mesh, size_t triangle) {
  const uint32_t* v = &mesh.indices[3 * triangle];
  return glm::normalize(
      glm::cross(mesh.positions[v[1]] - mesh.positions[v[0]], mesh.positions[v[2]] - mesh.positions[v[0]]));
}

TEST(GltfNormals, missingOnesStayMissingAndVerticesShared) {
  GltfText text;
  // A tent of two triangles that share an edge.
  const int positions = text.addVec3({{0, 0, 0}, {0, 0, 1}, {1, -1, 0}, {-1, -1, 0}});
  text.addNode({{"mesh", text.addMesh({{"POSITION", positions}}, text.addIndices({0, 1, 2, 1, 0, 3}))}});
  const Scene scene = text.load();
  EXPECT_EQ(scene.meshes[0].positions.size(), 4u);
  EXPECT_TRUE(scene.meshes[0].normals.empty());
}

TEST(GltfNormals, degenerateTrianglesAreKept) {
  GltfText text;
  const int positions = text.addVec3({{1, 2, 3}, {1, 2, 3}, {4, 5, 6}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  text.addNode({{"mesh", text.addMesh({{"POSITION", positions}}, -1)}});
  const Scene scene = text.load();
  EXPECT_EQ(triangleCount(scene), 2u);
}

TEST(GltfNormals, longOnesAreShortenedAndUnusableOnesMadeFromTheFaces) {
  GltfText text;
  const float nan = std::nanf("");
  const int normals = text.addVec3({{0, 0, 7}, {0, 0, 0}, {nan, 0, 0}});
  text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)}, {"NORMAL", normals}}, -1)}});
  const Scene scene = text.load();
  for (const glm::vec3& normal : scene.meshes[0].normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

// Four corners of a square in the order of a strip and of a fan: the same two triangles, facing +z.
TEST(GltfModes, stripsAndFansFaceTheSameWay) {
  const std::vector<glm::vec3> strip = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::vector<glm::vec3> fan = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (int mode : {5, 6}) {
    for (bool indexed : {false, true}) {
      GltfText text;
      const int positions = text.addVec3(mode == 5 ? strip : fan);
      const int indices = indexed ? text.addIndices({0, 1, 2, 3}) : -1;
      text.addNode({{"mesh", text.addMesh({{"POSITION", positions}}, indices, mode)}});
      const Scene scene = text.load();
      ASSERT_EQ(triangleCount(scene), 2u);
      for (size_t i = 0; i < 2; ++i) EXPECT_EQ(faceNormal(scene.meshes[0], i), glm::vec3(0, 0, 1)) << "mode " << mode;
    }
  }
}

TEST(GltfModes, linesAndPointsArePassedOver) {
  GltfText text;
  const int positions = text.addVec3(kTriangle);
  for (int mode : {0, 1, 2, 3, 4}) text.addNode({{"mesh", text.addMesh({{"POSITION", positions}}, -1, mode)}});
  const Scene scene = text.load();
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(triangleCount(scene), 1u);
}

TEST(GltfVertices, unusedOnesAreLeftOut) {
  GltfText text;
  const int positions = text.addVec3({{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}});
  const int normals = text.addVec3(std::vector<glm::vec3>(5, {0, 0, 1}));
  text.addNode({{"mesh", text.addMesh({{"POSITION", positions}, {"NORMAL", normals}}, text.addIndices({1, 3, 4}))}});
  const Scene scene = text.load();
  EXPECT_EQ(scene.meshes[0].positions, kTriangle);
  EXPECT_EQ(scene.meshes[0].indices, (std::vector<uint32_t>{0, 1, 2}));
}

TEST(GltfVertices, normalizedUvsAndByteIndices) {
  GltfText text;
  const uint8_t uvs[] = {0, 255, 51, 102, 255, 0};
  const uint8_t indices[] = {0, 1, 2};
  // Two bytes an element, tightly packed: glTF wants views of vertices aligned to 4, but the numbers are clear.
  const int uvAccessor = text.addAccessor(uvs, sizeof(uvs), 3, 5121, "VEC2", true);
  const int indexAccessor = text.addAccessor(indices, sizeof(indices), 3, 5121, "SCALAR", false);
  text.addNode(
      {{"mesh", text.addMesh(
                    {{"POSITION", text.addVec3(kTriangle)}, {"NORMAL", text.addVec3(kUp3)}, {"TEXCOORD_0", uvAccessor}},
                    indexAccessor)}});
  const Scene scene = text.load();
  EXPECT_EQ(scene.meshes[0].uvs[0], glm::vec2(0.0f, 1.0f));
  EXPECT_FLOAT_EQ(scene.meshes[0].uvs[1].x, 0.2f);
  EXPECT_FLOAT_EQ(scene.meshes[0].uvs[1].y, 0.4f);
}

TEST(GltfVertices, interleavedAttributes) {
  GltfText text;
  const float interleaved[] = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1};
  const int first = text.addAccessor(interleaved, sizeof(interleaved), 3, 5126, "VEC3", false);
  text.document["bufferViews"][0]["byteStride"] = 24;
  json second = text.document["accessors"][first];
  second["byteOffset"] = 12;
  text.document["accessors"].push_back(second);
  text.addNode({{"mesh", text.addMesh({{"POSITION", first}, {"NORMAL", first + 1}}, -1)}});
  const Scene scene = text.load();
  EXPECT_EQ(scene.meshes[0].positions, kTriangle);
  EXPECT_EQ(scene.meshes[0].normals, kUp3);
}

TEST(GltfTransforms, oneInstanceIsBaked) {
  GltfText text;
  const int mesh = text.addMesh({{"POSITION", text.addVec3(kTriangle)}, {"NORMAL", text.addVec3(kUp3)}}, -1);
  // A quarter turn about x takes +z to -y, then a scale of 2 and a move, the latter by a parent's matrix.
  const double h = std::sqrt(0.5);
  text.document["nodes"].push_back({{"mesh", mesh}, {"rotation", {h, 0, 0, h}}, {"scale", {2, 2, 2}}});
  text.addNode({{"children", {0}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
  const Scene scene = text.load();
  EXPECT_EQ(scene.instances[0].worldFromMesh, glm::mat4(1.0f));
  EXPECT_LT(glm::distance(scene.meshes[0].positions[0], glm::vec3(5, 6, 7)), 1e-6f);
  EXPECT_LT(glm::distance(scene.meshes[0].positions[1], glm::vec3(7, 6, 7)), 1e-6f);
  EXPECT_LT(glm::distance(scene.meshes[0].positions[2], glm::vec3(5, 6, 9)), 1e-6f);
  EXPECT_LT(glm::distance(scene.meshes[0].normals[0], glm::vec3(0, -1, 0)), 1e-6f);
}

TEST(GltfTransforms, unevenScaleTurnsNormalsByTheInverseTranspose) {
  GltfText text;
  const float s = std::sqrt(0.5f);
  const int positions = text.addVec3({{0, 0, 0}, {1, -1, 0}, {0, 0, 1}});
  const int normals = text.addVec3(std::vector<glm::vec3>(3, {-s, -s, 0}));
  text.addNode({{"mesh", text.addMesh({{"POSITION", positions}, {"NORMAL", normals}}, -1)}, {"scale", {3, 1, 1}}});
  const Scene scene = text.load();
  EXPECT_LT(glm::distance(scene.meshes[0].normals[0], faceNormal(scene.meshes[0], 0)), 1e-6f);
}

TEST(GltfTransforms, mirroredMeshKeepsItsFrontFaces) {
  GltfText text;
  const int mesh = text.addMesh({{"POSITION", text.addVec3(kTriangle)}, {"NORMAL", text.addVec3(kUp3)}}, -1);
  text.addNode({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
  const Scene scene = text.load();
  // Seen from +z it was counter-clockwise, and it still must be.
  EXPECT_EQ(faceNormal(scene.meshes[0], 0), glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.meshes[0].normals[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.meshes[0].positions[1], glm::vec3(-1, 0, 0));
}

TEST(GltfTransforms, sharedMeshesKeepTheirMatricesAndSigns) {
  GltfText text;
  const int mesh = text.addMesh({{"POSITION", text.addVec3(kTriangle)}, {"NORMAL", text.addVec3(kUp3)}}, -1);
  text.addNode({{"mesh", mesh}, {"translation", {4, 0, 0}}, {"name", "right"}});
  text.addNode({{"mesh", mesh}, {"scale", {-1, 1, 1}}, {"name", "mirrored"}});
  const Scene scene = text.load();
  ASSERT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.meshes[0].positions, kTriangle);
  EXPECT_EQ(scene.instances[0].worldFromMesh[3], glm::vec4(4, 0, 0, 1));
  EXPECT_EQ(scene.instances[1].name, "mirrored");
  EXPECT_LT(glm::determinant(scene.instances[1].worldFromMesh), 0.0f);
}

TEST(GltfTransforms, flattenedInstancesOfSharedMeshesAreBaked) {
  GltfText text;
  const int mesh = text.addMesh({{"POSITION", text.addVec3(kTriangle)}, {"NORMAL", text.addVec3(kUp3)}}, -1);
  text.addNode({{"mesh", mesh}});
  text.addNode({{"mesh", mesh}, {"scale", {1, 1, 0}}, {"translation", {0, 0, 2}}});
  text.addNode({{"mesh", mesh}, {"scale", {0, 0, 0}}});
  const Scene scene = text.load();
  ASSERT_EQ(scene.instances.size(), 3u);
  ASSERT_EQ(scene.meshes.size(), 3u);
  for (const Instance& instance : scene.instances) EXPECT_EQ(instance.worldFromMesh, glm::mat4(1.0f));
  EXPECT_EQ(scene.meshes[scene.instances[1].mesh].positions[2], glm::vec3(0, 1, 2));
  for (const Mesh& each : scene.meshes)
    for (const glm::vec3& normal : each.normals) EXPECT_NEAR(glm::length(normal), 1.0f, 1e-6f);
}

TEST(GltfTransforms, eachPrimitiveIsAMesh) {
  GltfText text;
  const int positions = text.addVec3(kTriangle);
  const int mesh = text.addMesh({{"POSITION", positions}}, -1);
  json second = text.document["meshes"][mesh]["primitives"][0];
  text.document["meshes"][mesh]["primitives"].push_back(second);
  text.document["meshes"][mesh]["name"] = "pair";
  text.addNode({{"mesh", mesh}});
  const Scene scene = text.load();
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[1].name, "pair 1");
  EXPECT_EQ(scene.instances.size(), 2u);
}

TEST(GltfLights, defaultsAndDirections) {
  GltfText text;
  text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)}}, -1)}});
  text.document["extensions"]["KHR_lights_punctual"]["lights"] =
      json::array({{{"type", "point"}, {"range", 3}},
                   {{"type", "spot"}, {"spot", json::object()}},
                   {{"type", "directional"}, {"color", {1, 0.5, 0}}, {"intensity", 2}}});
  const double h = std::sqrt(0.5);
  for (int i = 0; i < 3; ++i)
    text.addNode({{"translation", {1, 2, 3}},
                  {"scale", {2, 2, 2}},
                  {"rotation", {-h, 0, 0, h}},
                  {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const Scene scene = text.load();
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].positionW, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[0].intensity, 1.0f);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1.0f));
  EXPECT_FLOAT_EQ(scene.lights[1].outerConeRad, 0.7853981634f);
  EXPECT_EQ(scene.lights[1].innerConeRad, 0.0f);
  EXPECT_EQ(scene.lights[2].color, glm::vec3(1.0f, 0.5f, 0.0f));
  // -z turned by -90 degrees about x points down.
  for (int i : {1, 2}) EXPECT_LT(glm::distance(scene.lights[i].directionW, glm::vec3(0, -1, 0)), 1e-6f);
}

TEST(GltfCameras, areRigidWhateverTheNodesScale) {
  GltfText text;
  text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)}}, -1)}});
  text.document["cameras"] =
      json::array({{{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}},
                   {{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}}});
  text.addNode({{"camera", 0}});
  text.addNode({{"camera", 1}, {"scale", {3, -2, 0.5}}, {"translation", {1, 2, 3}}});
  const Scene scene = text.load();
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "eye");
  EXPECT_EQ(camera.yFovRad, 0.5f);
  EXPECT_EQ(camera.zNear, 0.25f);
  EXPECT_EQ(camera.worldFromEye[3], glm::vec4(1, 2, 3, 1));
  EXPECT_NEAR(glm::determinant(camera.worldFromEye), 1.0f, 1e-6f);
  EXPECT_EQ(camera.worldFromEye[2], glm::vec4(0, 0, 1, 0));
}

// A 2 x 1 image: opaque red and clear green.
std::string smallPng() {
  const fs::path path = fs::path(testing::TempDir()) / ("gnomon_small_" + std::to_string(::getpid()) + ".png");
  Image8 image(2, 1, 4);
  image.values = {255, 0, 0, 255, 0, 255, 0, 0};
  writePng(path, image);
  const std::string bytes = readFile(path);
  fs::remove(path);
  return bytes;
}

GltfText texturedTriangle(const json& textureInfo, const json& material) {
  GltfText text;
  const int uvs = text.addVec2({{0, 0}, {1, 0}, {0, 1}});
  text.document["images"] = json::array({{{"uri", "data:image/png;base64," + base64(smallPng())}}});
  text.document["samplers"] = json::array({{{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}});
  text.document["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
  json whole = material;
  whole["pbrMetallicRoughness"]["baseColorTexture"] = textureInfo;
  text.document["materials"] = json::array({whole});
  text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)}, {"TEXCOORD_0", uvs}}, -1, 4, 0)}});
  return text;
}

TEST(GltfMaterials, maskedTextureHasItsHolesWhereTheImageHas) {
  const Scene scene =
      texturedTriangle({{"index", 0}}, {{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}, {"doubleSided", true}}).load();
  const Material& material = scene.materials[0];
  EXPECT_EQ(material.alphaMode, AlphaMode::Mask);
  EXPECT_EQ(material.alphaCutoff, 0.25f);
  EXPECT_TRUE(material.doubleSided);
  EXPECT_EQ(scene.textures[0].filterMode, glsl::kTexFilterNearest);
  EXPECT_EQ(scene.textures[0].wrapS, glsl::kWrapClamp);
  EXPECT_EQ(scene.textures[0].wrapT, glsl::kWrapMirror);
  EXPECT_EQ(baseColorAt(scene, material, glm::vec2(0.2f, 0.5f)), glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(baseColorAt(scene, material, glm::vec2(0.8f, 0.5f)).w, 0.0f);
}

TEST(GltfMaterials, blendIsMaskedAtAHalf) {
  const Scene scene = texturedTriangle({{"index", 0}}, {{"alphaMode", "BLEND"}, {"alphaCutoff", 0.1}}).load();
  EXPECT_EQ(scene.materials[0].alphaMode, AlphaMode::Mask);
  EXPECT_EQ(scene.materials[0].alphaCutoff, 0.5f);
}

TEST(GltfMaterials, textureTransformIsAppliedToTheUvs) {
  // The example of KHR_texture_transform: a quarter turn, then a move.
  const json transform = {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}};
  const Scene scene =
      texturedTriangle({{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}, json::object()).load();
  const glm::vec2 expected[] = {{0, 1}, {0, 0.5f}, {0.5f, 1}};
  for (int i = 0; i < 3; ++i) EXPECT_LT(glm::distance(scene.meshes[0].uvs[i], expected[i]), 1e-6f) << i;
}

TEST(GltfMaterials, noMaterialIsWhiteOpaqueAndOneSided) {
  GltfText text;
  text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)}}, -1)}});
  const Scene scene = text.load();
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].baseColor, glm::vec4(1.0f));
  EXPECT_FALSE(scene.materials[0].doubleSided);
}

TEST(GltfFiles, buffersAndImagesBesideTheFileAreFound) {
  const fs::path folder = fs::path(testing::TempDir()) / ("gnomon files " + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::string bytes(36, '\0');
  std::copy_n(reinterpret_cast<const char*>(kTriangle.data()), 36, bytes.begin());
  writeTextFile(folder / "a b.bin", bytes);
  writeTextFile(folder / "small.png", smallPng());
  const json document = {{"asset", {{"version", "2.0"}}},
                         {"scenes", {{{"nodes", {0}}}}},
                         {"nodes", {{{"mesh", 0}}}},
                         {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"material", 0}}}}}}},
                         {"materials", {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}}},
                         {"textures", {{{"source", 0}}}},
                         {"images", {{{"uri", "small.png"}}}},
                         {"buffers", {{{"byteLength", 36}, {"uri", "a%20b.bin"}}}},
                         {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
                         {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}}};
  writeTextFile(folder / "scene.gltf", document.dump());
  const Scene scene = loadGltf(folder / "scene.gltf");
  EXPECT_EQ(scene.name, "scene");
  EXPECT_EQ(triangleCount(scene), 1u);
  EXPECT_EQ(scene.texels.size(), 2u);
  const std::string text = document.dump();
  EXPECT_THROW(loadGltfFromMemory(reinterpret_cast<const unsigned char*>(text.data()), text.size(), "m.gltf"),
               WorldError)
      << "a file in memory has no neighbours";
  fs::remove_all(folder);
}

TEST(RealScenes, load) {
  const fs::path folder = test::inSource("../shared/scenes");
  if (!fs::is_directory(folder)) GTEST_SKIP() << "skipped: ../shared/scenes is not here";
  // Triangles of all instances, and lights, as counted from the files' JSON.
  const struct {
    const char* file;
    uint64_t triangles;
    size_t lights, cameras;
  } expected[] = {{"chinesedragon.gltf", 100960, 0, 0},
                  {"shadowscene_fire.gltf", 4656, 0, 0},
                  {"godrays_pointlight.glb", 1240, 0, 0},
                  {"level_rpg3dm2.glb", 21236, 8, 4},
                  {"level_dm6.glb", 13420, 8, 4}};
  for (const auto& each : expected) {
    const Scene scene = loadGltf(folder / each.file);
    EXPECT_EQ(triangleCount(scene), each.triangles) << each.file;
    EXPECT_EQ(scene.lights.size(), each.lights) << each.file;
    EXPECT_EQ(scene.cameras.size(), each.cameras) << each.file;
    EXPECT_GT(computeBounds(scene).diagonal(), 1.0f) << each.file;
    for (const Mesh& mesh : scene.meshes)
      for (const glm::vec3& normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1.0f, 1e-4f) << each.file;
  }
}

// They are printed in tables, and are words of the command line.
TEST(GltfNames, controlCharactersAreEscaped) {
  GltfText text;
  const int mesh = text.addMesh({{"POSITION", text.addVec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}}, -1);
  text.document["meshes"][0]["name"] = "me\x1b[2Jsh";
  text.addNode({{"mesh", mesh}, {"name", "two\nlines"}});
  const Scene scene = text.load();
  EXPECT_EQ(scene.meshes.front().name, "me\\x1b[2Jsh");
  EXPECT_EQ(scene.instances.front().name, "two\\nlines");
}

// Of the processor, whatever else runs.
double secondsOfNodes(int count) {
  GltfText text;
  const int mesh = text.addMesh({{"POSITION", text.addVec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}}, -1);
  auto& nodes = text.document["nodes"] = nlohmann::json::array();
  auto& roots = text.document["scenes"][0]["nodes"] = nlohmann::json::array();
  for (int i = 0; i < count; ++i) {
    nodes.push_back({{"mesh", mesh}, {"translation", {i, 0, 0}}});
    roots.push_back(i);
  }
  const std::clock_t begin = std::clock();
  EXPECT_EQ(text.load().instances.size(), static_cast<size_t>(count));
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Quadratic, sixteen times as many would take 256 times as long.
TEST(GltfNodes, sixteenTimesAsManyTakeAboutSixteenTimesAsLong) {
  EXPECT_LT(secondsOfNodes(160'000), 80.0 * secondsOfNodes(10'000));
}

}  // namespace
}  // namespace gnomon
