// What becomes of each glTF extension and core attribute that can change a shadow: read, told, or refused by name.

#include "base/error.h"
#include "base/file.h"
#include "gltf_text.h"
#include "scene/gltf.h"
#include "scene/gltf_extensions.h"

#include "tests/base/places.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <unistd.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::vector<glm::vec3> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

std::string refusal(const GltfText& text) {
  try {
    text.load();
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

Scene loadText(const json& document) {
  const std::string text = document.dump();
  return loadGltfFromMemory(reinterpret_cast<const unsigned char*>(text.data()), text.size(), "made.gltf");
}

bool tells(const std::vector<std::string>& notes, const std::string& what) {
  return std::ranges::any_of(notes, [&](const std::string& note) { return note.find(what) != std::string::npos; });
}

GltfText oneTriangle() {
  GltfText text;
  text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)}}, -1)}});
  return text;
}

// Each row of the table by its own: those passed over are told apart from those that may change a shadow.
TEST(GltfExtensions, AreToldOrRefusedAsTheTableSays) {
  for (const GltfExtension& extension : gltfExtensions()) {
    std::string name(extension.name);
    std::ranges::replace(name, '*', 'x');
    GltfText text = oneTriangle();
    text.document["extensionsUsed"] = {name};
    const Scene scene = text.load();
    EXPECT_EQ(tells(scene.notes, name), extension.use == ExtensionUse::Told || extension.use == ExtensionUse::Refused)
        << name;
    EXPECT_EQ(tells(scene.harmlessNotes, name), extension.use == ExtensionUse::Harmless) << name;
    text.document["extensionsRequired"] = {name};
    EXPECT_EQ(refusal(text).find(name) != std::string::npos, extension.use == ExtensionUse::Refused) << refusal(text);
  }
  GltfText text = oneTriangle();
  text.document["extensionsUsed"] = {"ACME_teapot"};
  EXPECT_TRUE(tells(text.load().notes, "ACME_teapot is unknown"));
}

TEST(GltfExtensions, AreInTheDocumentationRowByRow) {
  const std::string page = readFile(test::inSource("docs/gltf.md"));
  for (const GltfExtension& extension : gltfExtensions())
    EXPECT_NE(page.find("| `" + std::string(extension.name) + "` |"), std::string::npos) << extension.name;
}

// CesiumGS/cesium #9943
TEST(GltfExtensions, SpecularGlossinessAlphaMakesTheHoles) {
  GltfText text;
  text.document["materials"] = {
      {{"alphaMode", "MASK"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}},
       {"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {0.5, 0.25, 0.125, 0.0625}}}}}}}};
  text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)}}, -1, 4, 0)}});
  EXPECT_EQ(text.load().materials.at(0).baseColor, glm::vec4(0.5f, 0.25f, 0.125f, 0.0625f));
}

TEST(GltfExtensions, HiddenNodesHideWhatIsBelowThemButNoCamera) {
  GltfText text;
  const int mesh = text.addMesh({{"POSITION", text.addVec3(kTriangle)}}, -1);
  text.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  text.document["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  const json below = {{"mesh", mesh}, {"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
  text.addNode({{"mesh", mesh}, {"name", "shown"}});
  const int hidden = text.addNode({{"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  text.document["nodes"].push_back(below);
  text.document["nodes"][hidden]["children"] = {text.document["nodes"].size() - 1};
  const Scene scene = text.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "shown");
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.cameras.size(), 1u);
}

TEST(GltfExtensions, GpuInstancesAreEachPlaced) {
  GltfText text;
  const std::vector<glm::vec3> places = {{0, 0, 0}, {5, 0, 0}, {0, 7, 0}}, sizes = {{1, 1, 1}, {2, 2, 2}, {1, 1, 3}};
  text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)}}, -1)},
                {"translation", {0, 0, 1}},
                {"extensions",
                 {{"EXT_mesh_gpu_instancing",
                   {{"attributes", {{"TRANSLATION", text.addVec3(places)}, {"SCALE", text.addVec3(sizes)}}}}}}}});
  const Scene scene = text.load();
  ASSERT_EQ(scene.instances.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(glm::vec3(scene.instances[i].worldFromMesh[3]), places[i] + glm::vec3(0, 0, 1));
    EXPECT_EQ(scene.instances[i].worldFromMesh[2].z, sizes[i].z);
  }
}

// Two triangles that draco::Encoder packed, positions quantized to 16 bits: (0 0 0, 4 0 0, 0 4 0) and
// (4 0 0, 4 4 2, 0 4 0).
constexpr const char* kDracoQuad =
    "RFJBQ08CAgEBAAAABAIAAgAAAR//AREB/wAAAQAJAwAAAgEBAQARAwEgARAzARADADCQSgAAAgD+/wEAAAAA//8AAAAAAAAAAAAAAAAAAAAAgEAQ";
constexpr size_t kDracoBytes = 84;

TEST(GltfExtensions, DracoMeshesAreUnpacked) {
  GltfText text;
  // Such accessors have no bufferView: their elements are in the compressed bytes.
  text.document["accessors"] = {{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                                {{"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}};
  const int shape = text.addMesh({{"POSITION", 0}}, 1);
  text.addNode({{"mesh", shape}});
  text.document["meshes"][shape]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
  text.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  text.document["bufferViews"] = {{{"buffer", 0}, {"byteLength", kDracoBytes}}};
  text.document["buffers"] = {
      {{"byteLength", kDracoBytes}, {"uri", std::string("data:application/octet-stream;base64,") + kDracoQuad}}};
  const Scene scene = loadText(text.document);
  ASSERT_EQ(triangleCount(scene), 2u);
  const Bounds bounds = computeBounds(scene);
  EXPECT_LT(glm::distance(bounds.lower, glm::vec3(0)), 1e-3f);
  EXPECT_LT(glm::distance(bounds.upper, glm::vec3(4, 4, 2)), 1e-3f);
}

TEST(GltfExtensions, MeshoptViewsAreUnpacked) {
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 5}};
  const std::vector<uint32_t> indices = {0, 1, 2, 2, 1, 3};
  std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(positions.size(), sizeof(glm::vec3)));
  vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), positions.data(), positions.size(),
                                             sizeof(glm::vec3)));
  std::vector<unsigned char> triangles(meshopt_encodeIndexBufferBound(indices.size(), positions.size()));
  triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), indices.size()));
  std::string bytes(vertices.begin(), vertices.end());
  bytes.resize((bytes.size() + 3) / 4 * 4);
  const size_t start = bytes.size();
  bytes.append(triangles.begin(), triangles.end());

  GltfText text = oneTriangle();
  const auto view = [](size_t size, size_t stride, size_t count, const char* mode, size_t offset, size_t length) {
    return json{{"buffer", 1},
                {"byteLength", size},
                {"extensions",
                 {{"EXT_meshopt_compression",
                   {{"buffer", 0},
                    {"byteOffset", offset},
                    {"byteLength", length},
                    {"byteStride", stride},
                    {"count", count},
                    {"mode", mode}}}}}};
  };
  text.document["buffers"] = {
      {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}},
      {{"byteLength", 72}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  text.document["bufferViews"] = {view(48, 12, 4, "ATTRIBUTES", 0, vertices.size()),
                                  view(24, 4, 6, "TRIANGLES", start, triangles.size())};
  text.document["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                                {{"bufferView", 1}, {"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}}};
  text.document["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
  text.document["extensionsRequired"] = {"EXT_meshopt_compression"};
  const Scene scene = loadText(text.document);
  EXPECT_EQ(triangleCount(scene), 2u);
  EXPECT_EQ(computeBounds(scene).upper, glm::vec3(1, 1, 5));
}

TEST(GltfAttributes, AccessorsWithoutViewAreZeroAndSparseOnesWriteOver) {
  GltfText text;
  const int values = text.addVec3({{9, 8, 7}});
  const uint16_t at = 2;
  const int indices = text.addAccessor(&at, sizeof(at), 1, 5123, "SCALAR", false);
  const int positions = text.addVec3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const auto viewOf = [&](int accessor) { return text.document["accessors"][accessor]["bufferView"]; };
  text.document["accessors"][positions]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", viewOf(indices)}, {"componentType", 5123}}},
      {"values", {{"bufferView", viewOf(values)}}}};
  text.document["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
  text.addNode({{"mesh", text.addMesh({{"POSITION", positions}, {"TEXCOORD_0", 3}}, -1)}});
  const Scene scene = text.load();
  EXPECT_EQ(scene.meshes[0].positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {9, 8, 7}}));
  EXPECT_EQ(scene.meshes[0].uvs, std::vector<glm::vec2>(3, glm::vec2(0)));
}

TEST(GltfAttributes, APrimitiveWithoutPositionsIsPassedOver) {
  GltfText text = oneTriangle();
  text.document["meshes"][0]["primitives"].push_back({{"attributes", json::object()}});
  const Scene scene = text.load();
  EXPECT_EQ(triangleCount(scene), 1u);
  EXPECT_TRUE(tells(scene.notes, "primitive 1 has no POSITION"));
}

TEST(GltfAttributes, TheAlphaOfVerticesMultipliesAMasks) {
  const std::vector<glm::vec4> even(3, glm::vec4(1, 1, 1, 0.25f)),
      uneven = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0.5f}};
  const auto load = [&](const std::vector<glm::vec4>& colors, const char* alphaMode) {
    GltfText text;
    text.document["materials"] = {
        {{"alphaMode", alphaMode}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}}};
    const int accessor = text.addAccessor(colors.data(), colors.size() * sizeof(glm::vec4), 3, 5126, "VEC4", false);
    text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)}, {"COLOR_0", accessor}}, -1, 4, 0)}});
    return text;
  };
  const Scene masked = load(even, "MASK").load();
  EXPECT_EQ(masked.materials[masked.meshes[0].material].baseColor.w, 0.125f);
  EXPECT_EQ(load(even, "OPAQUE").load().materials.size(), 1u);
  EXPECT_NE(refusal(load(uneven, "MASK")).find("COLOR_0"), std::string::npos);
  EXPECT_EQ(refusal(load(uneven, "OPAQUE")), "");
}

TEST(GltfAttributes, UvsThatNothingReadsMayBeAnything) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  GltfText text;
  text.addNode({{"mesh", text.addMesh({{"POSITION", text.addVec3(kTriangle)},
                                       {"TEXCOORD_0", text.addVec2({{nan, 0}, {0, 0}, {0, nan}})}},
                                      -1)}});
  EXPECT_EQ(text.load().meshes[0].uvs[0], glm::vec2(0));
}

TEST(GltfMaterials, ATextureThatCannotBeReadMattersOnlyWhereItMakesHoles) {
  const auto load = [](const char* alphaMode) {
    GltfText text = oneTriangle();
    text.document["images"] = {{{"uri", "not_there.png"}}};
    text.document["textures"] = {{{"source", 0}}};
    text.document["materials"] = {
        {{"alphaMode", alphaMode}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    text.document["meshes"][0]["primitives"][0]["material"] = 0;
    return text;
  };
  const Scene opaque = load("OPAQUE").load();
  EXPECT_TRUE(tells(opaque.notes, "not_there.png"));
  EXPECT_EQ(opaque.materials[0].baseColorTexture, -1);
  EXPECT_NE(refusal(load("MASK")).find("not_there.png"), std::string::npos);
}

TEST(GltfMaterials, BlendingIsTold) {
  GltfText text = oneTriangle();
  text.document["materials"] = {{{"name", "glass"}, {"alphaMode", "BLEND"}}};
  EXPECT_TRUE(tells(text.load().notes, "'glass' is alpha-blended"));
}

// tinygltf #369, and data: URIs of any type and case.
TEST(GltfUris, AreDecodedAsTheStandardSays) {
  const fs::path folder = fs::path(testing::TempDir()) / ("gnomon uris " + std::to_string(::getpid()));
  fs::create_directories(folder / "below");
  const auto write = [&](const fs::path& path, float height) {
    const std::vector<glm::vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, height, 0}};
    writeTextFile(path, std::string(reinterpret_cast<const char*>(corners.data()), 36));
  };
  write(folder / "a+b.bin", 2.0f);
  write(folder / "a b.bin", 3.0f);
  write(folder / "100%.bin", 4.0f);
  write(folder / "below" / "c.bin", 5.0f);
  GltfText text = oneTriangle();
  const auto heightOf = [&](const std::string& uri, const fs::path& at, const GltfOptions& options = {}) {
    json document = text.finished();
    document["buffers"][0]["uri"] = uri;
    writeTextFile(at / "scene.gltf", document.dump());
    return computeBounds(loadGltf(at / "scene.gltf", options)).upper.y;
  };
  EXPECT_EQ(heightOf("a+b.bin", folder), 2.0f);
  EXPECT_EQ(heightOf("a%2Bb.bin", folder), 2.0f);
  EXPECT_EQ(heightOf("a%20b.bin", folder), 3.0f);
  EXPECT_EQ(heightOf("a b.bin", folder), 3.0f);
  EXPECT_EQ(heightOf("100%.bin", folder), 4.0f);
  EXPECT_EQ(heightOf("below/../below/c.bin", folder), 5.0f);
  const std::string bytes(reinterpret_cast<const char*>(kTriangle.data()), 36);
  EXPECT_EQ(heightOf("DATA:Model/Odd;charset=utf-8;BASE64," + base64(bytes), folder), 1.0f);
  // A way out of the folder is closed, by name and by link, but where it is opened.
  EXPECT_THROW(heightOf("../a+b.bin", folder / "below"), WorldError);
  EXPECT_THROW(heightOf((folder / "a+b.bin").string(), folder / "below"), WorldError);
  fs::create_symlink(folder / "a+b.bin", folder / "below" / "link.bin");
  EXPECT_THROW(heightOf("link.bin", folder / "below"), WorldError);
  EXPECT_EQ(heightOf("../a+b.bin", folder / "below", {.allowedFolders = {folder}}), 2.0f);
  fs::remove_all(folder);
}

TEST(GltfNodes, RoundingInAMatrixsLastRowIsNoShear) {
  GltfText text = oneTriangle();
  text.document["nodes"][0]["matrix"] = {1, 0, 0, 1e-9, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 0.99999994};
  EXPECT_EQ(computeBounds(text.load()).lower.x, 3.0f);
  text.document["nodes"][0]["matrix"][3] = 0.01;
  EXPECT_NE(refusal(text), "");
}

TEST(GltfNodes, LightsOfOneNameAreToldApart) {
  GltfText text = oneTriangle();
  text.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"range", 5.0}}};
  const json light = {{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
  const int left = text.addNode({{"name", "left"}}), right = text.addNode({{"name", "right"}});
  for (const int parent : {left, right}) {
    text.document["nodes"].push_back(light);
    text.document["nodes"][parent]["children"] = {text.document["nodes"].size() - 1};
  }
  text.addNode(light);
  text.addNode(light);
  const Scene scene = text.load();
  std::vector<std::string> names, paths;
  for (const Light& each : scene.lights) {
    names.push_back(each.name);
    paths.push_back(each.path);
  }
  EXPECT_EQ(paths, (std::vector<std::string>{"left/lamp", "right/lamp", "lamp", "lamp"}));
  EXPECT_EQ(names, (std::vector<std::string>{"left/lamp", "right/lamp", "lamp", "lamp #3"}));
  EXPECT_TRUE(tells(scene.notes, "ends at 5 m"));
}

// filament #7241: every coordinate is exact, so nothing changes but the origin.
TEST(GltfNodes, AFarSceneGetsAnOriginOfItsOwn) {
  GltfText near = oneTriangle(), far = oneTriangle();
  far.document["nodes"][0]["translation"] = {65536, -131072, 0};
  const Scene a = near.load(), b = far.load();
  EXPECT_EQ(a.originW, glm::dvec3(0));
  EXPECT_EQ(b.originW, glm::dvec3(65536, -131072, 0));
  EXPECT_EQ(a.meshes[0].positions, b.meshes[0].positions);
  EXPECT_TRUE(tells(b.notes, "from its origin"));
}

}  // namespace
}  // namespace gnomon
