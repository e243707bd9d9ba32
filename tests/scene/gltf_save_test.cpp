// A scene that is saved and loaded again is equal: the same floats, to the last bit where the comparison says ==.

#include "base/error.h"
#include "base/file.h"
#include "scene/generate.h"
#include "scene/gltf.h"
#include "tests/base/file_limit.h"
#include "tests/base/places.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() : path_(fs::path(testing::TempDir()) / ("gnomon_save_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

void expectEqual(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.name, b.name);
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (size_t i = 0; i < a.meshes.size(); ++i) {
    const Mesh &m = a.meshes[i], &n = b.meshes[i];
    EXPECT_EQ(m.name, n.name);
    EXPECT_TRUE(m.positions == n.positions) << m.name;
    EXPECT_TRUE(m.normals == n.normals) << m.name;
    EXPECT_TRUE(m.uvs == n.uvs) << m.name;
    EXPECT_TRUE(m.indices == n.indices) << m.name;
    EXPECT_EQ(m.material, n.material) << m.name;
    EXPECT_EQ(m.closed, n.closed) << m.name;
  }
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (size_t i = 0; i < a.materials.size(); ++i) {
    const Material &m = a.materials[i], &n = b.materials[i];
    EXPECT_EQ(m.name, n.name);
    EXPECT_EQ(m.baseColor, n.baseColor) << m.name;
    EXPECT_EQ(m.baseColorTexture, n.baseColorTexture) << m.name;
    EXPECT_EQ(m.alphaMode, n.alphaMode) << m.name;
    EXPECT_EQ(m.alphaCutoff, n.alphaCutoff) << m.name;
    EXPECT_EQ(m.doubleSided, n.doubleSided) << m.name;
  }
  ASSERT_EQ(a.textures.size(), b.textures.size());
  for (size_t i = 0; i < a.textures.size(); ++i) {
    const glsl::TextureInfo &s = a.textures[i], &t = b.textures[i];
    EXPECT_EQ(s.firstTexel, t.firstTexel);
    EXPECT_EQ(s.width, t.width);
    EXPECT_EQ(s.height, t.height);
    EXPECT_EQ(s.wrapS, t.wrapS);
    EXPECT_EQ(s.wrapT, t.wrapT);
    EXPECT_EQ(s.filterMode, t.filterMode);
  }
  EXPECT_TRUE(a.texels == b.texels);
  ASSERT_EQ(a.instances.size(), b.instances.size());
  for (size_t i = 0; i < a.instances.size(); ++i) {
    EXPECT_EQ(a.instances[i].name, b.instances[i].name);
    EXPECT_EQ(a.instances[i].mesh, b.instances[i].mesh);
    EXPECT_EQ(a.instances[i].worldFromMesh, b.instances[i].worldFromMesh);
  }
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (size_t i = 0; i < a.lights.size(); ++i) {
    const Light &l = a.lights[i], &k = b.lights[i];
    EXPECT_EQ(l.name, k.name);
    EXPECT_EQ(l.type, k.type);
    EXPECT_EQ(l.positionW, k.positionW) << l.name;
    EXPECT_EQ(l.directionW, k.directionW) << l.name;
    EXPECT_EQ(l.color, k.color) << l.name;
    EXPECT_EQ(l.intensity, k.intensity) << l.name;
    EXPECT_EQ(l.innerConeRad, k.innerConeRad) << l.name;
    EXPECT_EQ(l.outerConeRad, k.outerConeRad) << l.name;
  }
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (size_t i = 0; i < a.cameras.size(); ++i) {
    EXPECT_EQ(a.cameras[i].name, b.cameras[i].name);
    EXPECT_EQ(a.cameras[i].worldFromEye, b.cameras[i].worldFromEye) << a.cameras[i].name;
    EXPECT_EQ(a.cameras[i].yFovRad, b.cameras[i].yFovRad);
    EXPECT_EQ(a.cameras[i].zNear, b.cameras[i].zNear);
  }
}

class RoundTrip : public testing::TestWithParam<GeneratedScene> {};

TEST_P(RoundTrip, generatedSceneLoadsAgainEqual) {
  const Folder folder;
  const Scene scene = GetParam().make();
  const fs::path path = folder / (scene.name + ".glb");
  saveGlb(scene, path);
  const Scene loaded = loadGltf(path);
  expectEqual(scene, loaded);
  // And the bytes of a second save are those of the first.
  const std::string first = readFile(path);
  saveGlb(loaded, path);
  EXPECT_TRUE(readFile(path) == first);
}

INSTANTIATE_TEST_SUITE_P(All, RoundTrip, testing::ValuesIn(generatedScenes()),
                         [](const testing::TestParamInfo<GeneratedScene>& each) {
                           std::string name = each.param.name;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(RoundTripOfFiles, realScenesLoadAgainEqual) {
  if (!fs::is_directory(test::inSource("../shared/scenes"))) GTEST_SKIP() << "skipped: ../shared/scenes is not here";
  const Folder folder;
  size_t scenes = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::inSource("../shared/scenes"))) {
    if (entry.path().extension() != ".glb" && entry.path().extension() != ".gltf") continue;
    const Scene scene = loadGltf(entry.path());
    const fs::path path = folder / (scene.name + ".glb");
    saveGlb(scene, path);
    expectEqual(scene, loadGltf(path));
    ++scenes;
  }
  EXPECT_GT(scenes, 0u);
}

// Every kind of light and material at once, with awkward names, directions and numbers.
TEST(RoundTripOfFiles, awkwardSceneLoadsAgainEqual) {
  const Folder folder;
  Scene scene = openScene("sheets");
  scene.name = "awkward";
  scene.materials[0].name = "q\"uo\\te \xc3\xa9\n";
  scene.materials[1].alphaMode = AlphaMode::Mask;
  scene.materials[1].alphaCutoff = 0.1f;
  scene.textures.push_back(scene.textures[0]);
  scene.textures[1].wrapS = glsl::kWrapMirror;
  scene.textures[1].filterMode = glsl::kTexFilterLinear;
  scene.materials[1].baseColorTexture = 1;
  scene.materials[1].baseColor = glm::vec4(0.1f, 1.0f / 3.0f, 0.7f, 0.9f);
  scene.lights.clear();
  const glm::vec3 directions[] = {{0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {0.6f, -0.8f, 0.0f}};
  for (const glm::vec3& direction : directions) {
    for (LightType type : {LightType::Point, LightType::Spot, LightType::Directional}) {
      Light light;
      light.name = "light " + std::to_string(scene.lights.size());
      light.type = type;
      if (type != LightType::Point) light.directionW = direction;
      if (type != LightType::Directional) light.positionW = glm::vec3(0.1f, 1e-20f, -12345.678f);
      if (type == LightType::Spot) {
        light.innerConeRad = 0.1f;
        light.outerConeRad = 1.1f;
      }
      light.color = glm::vec3(0.1f, 0.2f, 0.3f);
      light.intensity = 1.0f / 3.0f;
      scene.lights.push_back(light);
    }
  }
  scene.cameras.push_back(lookAt("down", {0, 5, 0}, {0, 0, 0}, 1.0f));
  scene.cameras.push_back(lookAt("aslant", {0.1f, 5.3f, -7.7f}, {0.3f, 0.2f, 0.1f}, 0.7f));
  const fs::path path = folder / "awkward.glb";
  saveGlb(scene, path);
  expectEqual(scene, loadGltf(path));
}

TEST(SaveGlb, aFullDiskLeavesTheOldFileWhereverItIsFull) {
  const Folder folder;
  const Scene scene = openScene("corner");
  test::expectWholeOrOld<WorldError>(folder / "a.glb", [&] { saveGlb(scene, folder / "a.glb"); });
}

TEST(SaveGlb, unwritablePlaceIsAWorldErrorAndLeavesNothing) {
  EXPECT_THROW(saveGlb(openScene("corner"), "/proc/no/such/place.glb"), WorldError);
}

}  // namespace
}  // namespace gnomon
