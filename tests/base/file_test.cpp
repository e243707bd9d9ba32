// Nothing half-written is left under a final name, and nothing beside it.
#include "base/file.h"
#include "base/error.h"
#include "tests/base/temporary_folder.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class FileTest : public ::testing::Test {
 protected:
  size_t fileCount() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  const test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

TEST_F(FileTest, AnErrorWhileWritingLeavesTheOldFileAndNothingElse) {
  const fs::path path = folder_ / "results.json";
  writeTextFile(path, "old");
  EXPECT_THROW(writeAtomically(path,
                               [](const fs::path& aside) {
                                 std::ofstream(aside) << "half";
                                 throw WorldError("no room");
                               }),
               WorldError);
  EXPECT_EQ(readFile(path), "old");
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(FileTest, FoldersAreMadeAndBytesKept) {
  const std::string bytes("a\0b\r\n", 5);
  writeTextFile(folder_ / "a" / "b" / "c.bin", bytes);
  EXPECT_EQ(readFile(folder_ / "a" / "b" / "c.bin"), bytes);
}

TEST_F(FileTest, WhatCannotBeReadOrWrittenIsNamed) {
  const auto messageOf = [](auto&& action) {
    try {
      action();
    } catch (const WorldError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(messageOf([&] { readFile(folder_ / "absent"); }).find("absent: cannot be read"), std::string::npos);
  EXPECT_NE(messageOf([&] { readFile(folder_); }).find("is a folder"), std::string::npos);
  writeTextFile(folder_ / "file", "");
  EXPECT_NE(messageOf([&] { writeTextFile(folder_ / "file" / "below", ""); }).find("file: cannot"), std::string::npos);
}

}  // namespace
}  // namespace gnomon
