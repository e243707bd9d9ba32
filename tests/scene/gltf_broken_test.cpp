// Every file of the corpus of tools/make_broken_gltf.py is refused with one line a person can use.

#include "base/error.h"
#include "base/file.h"
#include "scene/gltf.h"

#include "tests/base/places.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> corpus() {
  std::vector<std::string> names;
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator(test::inBuild("tests/scene/broken_gltf"), failure))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void expectOneLine(const std::string& message, const std::string& name) {
  EXPECT_NE(message.find(name), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_EQ(message.find("terminate"), std::string::npos) << message;
  // "file: what; remedy", none of them empty.
  const size_t colon = message.find(name) + name.size(), semicolon = message.rfind("; ");
  EXPECT_EQ(message.substr(colon, 2), ": ") << message;
  ASSERT_NE(semicolon, std::string::npos) << message;
  EXPECT_GT(semicolon, colon + 8) << message;
  EXPECT_GT(message.size(), semicolon + 8) << message;
  EXPECT_LT(message.size(), 600u) << message;
}

class BrokenGltf : public testing::TestWithParam<std::string> {};

TEST_P(BrokenGltf, isRefusedWithOneLine) {
  const fs::path path = fs::path(test::inBuild("tests/scene/broken_gltf")) / GetParam();
  try {
    loadGltf(path);
    FAIL() << GetParam() << " was loaded";
  } catch (const WorldError& error) {
    expectOneLine(error.what(), GetParam());
  }
}

TEST_P(BrokenGltf, isRefusedFromMemoryToo) {
  const std::string bytes = readFile(fs::path(test::inBuild("tests/scene/broken_gltf")) / GetParam());
  EXPECT_THROW(loadGltfFromMemory(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), GetParam()),
               WorldError);
}

INSTANTIATE_TEST_SUITE_P(Corpus, BrokenGltf, testing::ValuesIn(corpus()),
                         [](const testing::TestParamInfo<std::string>& each) {
                           std::string name = each.param;
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

TEST(BrokenCorpus, isThere) {
  EXPECT_GE(corpus().size(), 40u);
}

TEST(BrokenCorpus, missingFileIsNamed) {
  EXPECT_THROW(loadGltf("/no/such/file.glb"), WorldError);
}

}  // namespace
}  // namespace gnomon
