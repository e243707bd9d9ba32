// Every sample runs, says nothing of validation, and draws the picture it drew before.
#include "base/file.h"
#include "base/image.h"
#include "gpu/device.h"
#include "tests/base/temporary_folder.h"

#include <cstdlib>

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
  const std::string command = std::string(GNOMON_SAMPLES_DIR) + "/" + name + " " + GetParam().scene + " " +
                              picture.string() + " 2>" + messages.string() + " >/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0) << readFile(messages);
  EXPECT_EQ(readFile(messages), "");
  const std::filesystem::path golden = std::filesystem::path(GNOMON_TEST_DIR) / "golden" / (name + ".png");
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
                                           Sample{"03_lamp_in_fog", "grate"}),
                         [](const auto& sample) { return std::string(sample.param.name); });

TEST(SampleMistakes, AMissingSceneIsOneLine) {
  const test::TemporaryFolder folder;
  const std::filesystem::path messages = folder.path() / "stderr";
  const std::string command =
      std::string(GNOMON_SAMPLES_DIR) + "/01_point_light_cube nowhere.glb x.png 2>" + messages.string();
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_NE(readFile(messages).find("nowhere.glb"), std::string::npos);
}

}  // namespace
}  // namespace gnomon
