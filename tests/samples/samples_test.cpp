// Every sample runs, says nothing of validation, and draws the picture it drew before.
#include "base/file.h"
#include "base/image.h"
#include "gpu/device.h"
#include "tests/base/places.h"
#include "tests/base/temporary_folder.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

struct Sample {
  const char* name;
  const char* scene;
};
void PrintTo(const Sample& sample, std::ostream* out) {  // part of the test's name
  *out << sample.name;
}
class Samples : public ::testing::TestWithParam<Sample> {};

// On lavapipe the pictures are equal to the byte; another device rounds otherwise, and a shadow test may fall
// to the other side in half a percent of the pixels.
TEST_P(Samples, DrawsItsPicture) {
  const test::TemporaryFolder folder;
  const std::string name = GetParam().name;
  const std::filesystem::path picture = folder.path() / "picture.png";
  const std::filesystem::path messages = folder.path() / "stderr";
  const std::string command = test::inBuild("samples") + "/" + name + " " + GetParam().scene + " " + picture.string() +
                              " 2>" + messages.string() + " >/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0) << readFile(messages);
  EXPECT_EQ(readFile(messages), "");
  const std::filesystem::path golden =
      std::filesystem::path(test::inSource("tests/samples")) / "golden" / (name + ".png");
  if (std::getenv("GNOMON_BLESS") != nullptr)
    std::filesystem::copy_file(picture, golden, std::filesystem::copy_options::overwrite_existing);
  const ImageF expected = readImage(golden);
  const ImageF drawn = readImage(picture);
  ASSERT_EQ(expected.values.size(), drawn.values.size());
  size_t different = 0;
  for (size_t i = 0; i < drawn.values.size(); ++i) different += expected.values[i] != drawn.values[i] ? 1 : 0;
  const bool lavapipe = gpu::Device::create({})->info().name.find("llvmpipe") != std::string::npos;
  EXPECT_LE(different, lavapipe ? size_t{0} : drawn.values.size() / 200);
}

INSTANTIATE_TEST_SUITE_P(All, Samples,
                         ::testing::Values(Sample{"01_point_light_cube", "contact"},
                                           Sample{"02_point_light_paraboloid", "contact"},
                                           Sample{"03_shadow_volume", "contact"}, Sample{"04_lamp_in_fog", "grate"}),
                         [](const auto& sample) { return std::string(sample.param.name); });

bool drawsOnLavapipe() {
  const std::vector<gpu::DeviceInfo> devices = gpu::listDevices();
  return !devices.empty() && devices.front().driver.starts_with("llvmpipe");
}

// Of docs/add_a_parameterization.md: it stands in the table beside the cube, covers every pixel, and its
// adaptive bias works.
TEST(Samples05, AMapOfOnesOwnIsScoredBesideTheCube) {
  const test::TemporaryFolder folder;
  const std::filesystem::path table = folder.path() / "stdout";
  const std::string command = test::inBuild("samples") + "/05_map_of_my_own tilted-planes 98304 >" + table.string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::istringstream lines(readFile(table));
  int rows = 0;  // map side bias parameters... acne leak edge bias-error all-wrong rmse frame-ms
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string map, side, bias, word;
    words >> map >> side >> bias;
    if (map != "tetrahedron") continue;
    ++rows;
    std::vector<std::string> rest;
    while (words >> word) rest.push_back(word);
    ASSERT_GE(rest.size(), 7u);
    const std::string acne = rest[rest.size() - 7];
    if (bias == "adaptive") {
      // A GPU interpolates depth between corners on a grid of 1/256 texel: the paper's epsilon is less than that.
      EXPECT_LE(std::stol(acne), drawsOnLavapipe() ? 0 : 2000) << line;
    }
    if (bias == "none") {
      EXPECT_GT(std::stol(acne), 1000) << line;
    }
  }
  EXPECT_EQ(rows, 4);
}

std::string messageOf(const std::filesystem::path& scene, const std::filesystem::path& folder) {
  const std::filesystem::path messages = folder / "stderr";
  const std::string command = test::inBuild("samples") + "/01_point_light_cube " + scene.string() + " " +
                              (folder / "x.png").string() + " 2>" + messages.string();
  EXPECT_NE(std::system(command.c_str()), 0);
  const std::string message = readFile(messages);
  EXPECT_EQ(std::ranges::count(message, '\n'), 1) << message;
  return message;
}

TEST(SampleMistakes, AMissingSceneIsOneLine) {
  const test::TemporaryFolder folder;
  EXPECT_NE(messageOf("nowhere.glb", folder.path()).find("nowhere.glb"), std::string::npos);
}

TEST(SampleMistakes, ASceneWithoutACameraIsOneLine) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "triangle.gltf";
  writeTextFile(path, R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "buffers":[{"byteLength":36,
      "uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  EXPECT_NE(messageOf(path, folder.path()).find("has no camera"), std::string::npos);
}

}  // namespace
}  // namespace gnomon
