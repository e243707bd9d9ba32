// Nothing half-written is left under a final name, and nothing beside it; what is no file is written through.
#include "base/file.h"
#include "base/error.h"
#include "tests/base/file_limit.h"
#include "tests/base/started_process.h"
#include "tests/base/temporary_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <ostream>
#include <thread>

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

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

// A process that has ended, whose number is not in use again so soon.
pid_t endedProcess() {
  const pid_t process = test::startProcess({"/bin/true"});
  test::statusOf(process);
  return process;
}

TEST_F(FileTest, AnErrorWhileWritingLeavesTheOldFileAndNothingElse) {
  const fs::path path = folder_ / "results.json";
  writeTextFile(path, "old");
  EXPECT_THROW(writeFile(path,
                         [](std::ostream& out) {
                           out << "half";
                           throw WorldError("no room");
                         }),
               WorldError);
  EXPECT_EQ(readFile(path), "old");
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(FileTest, AFullDiskLeavesTheOldFileWhereverItIsFull) {
  const std::string text(700'000, 'x');  // several of the buffer's
  test::expectWholeOrOld<WorldError>(folder_ / "text", [&] { writeTextFile(folder_ / "text", text); });
}

TEST_F(FileTest, AStreamSeeks) {
  for (const char* name : {"file", "pipe"}) {
    const fs::path path = folder_ / name;
    std::string read;
    std::thread reader;
    if (path.filename() == "pipe") {
      ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
      reader = std::thread([&] { read = readFile(path); });
    }
    writeFile(path, [](std::ostream& out) {
      out << "0123456789";
      EXPECT_EQ(static_cast<int>(out.tellp()), 10);
      out.seekp(2);
      out << "ab";
      out.seekp(0, std::ios::end);
      out << "end";
    });
    if (reader.joinable()) reader.join();
    EXPECT_EQ(read.empty() ? readFile(path) : read, "01ab456789end") << name;
  }
}

TEST_F(FileTest, PipesAndDevicesAreWrittenThroughAndStay) {
  const fs::path device = "/dev/null";
  writeTextFile(device, "text");
  EXPECT_TRUE(fs::is_character_file(device));
  EXPECT_TRUE(isStream(device));
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = readFile(folder_ / "pipe"); });
  writeTextFile(folder_ / "pipe", "through");
  reader.join();
  EXPECT_EQ(read, "through");
  EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
  EXPECT_EQ(fileCount(), 1u);
  const std::string full = messageOf([] { writeTextFile("/dev/full", "text"); });
  EXPECT_NE(full.find("/dev/full: cannot be written; No space left"), std::string::npos) << full;
}

TEST_F(FileTest, NothingIsMadeAmongTheKernelsThings) {
  for (const char* path : {"/dev/gnomon-test.json", "/proc/gnomon-test.json", "/sys/gnomon-test.json"}) {
    EXPECT_NE(messageOf([&] { checkOutput(path); }).find("is no device"), std::string::npos) << path;
    EXPECT_NE(messageOf([&] { writeTextFile(path, ""); }).find("is no device"), std::string::npos) << path;
    EXPECT_FALSE(fs::exists(path));
  }
  fs::create_directory_symlink("/dev", folder_ / "link");
  EXPECT_THROW(writeTextFile(folder_ / "link" / "gnomon-test.json", ""), WorldError);
  EXPECT_FALSE(fs::exists("/dev/gnomon-test.json"));
}

TEST_F(FileTest, SymbolicLinksAreFollowed) {
  fs::create_directory(folder_ / "below");
  fs::create_symlink("below/target", folder_ / "link");
  fs::create_symlink("link", folder_ / "second");
  fs::create_symlink("round", folder_ / "round");
  for (const char* text : {"first", "again"}) {
    writeTextFile(folder_ / "second", text);
    EXPECT_TRUE(fs::is_symlink(folder_ / "second"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(readFile(folder_ / "below" / "target"), text);
  }
  EXPECT_NE(messageOf([&] { writeTextFile(folder_ / "round", ""); }).find("ends nowhere"), std::string::npos);
}

TEST_F(FileTest, LinksToWhatIsNotThereAreFollowedToo) {
  fs::create_symlink("elsewhere/folder", folder_ / "link");
  EXPECT_EQ(followLinks(folder_ / "link"), folder_ / "elsewhere/folder");
  EXPECT_EQ(followLinks(folder_ / "none"), folder_ / "none");
  fs::create_symlink("round", folder_ / "round");
  EXPECT_NE(messageOf([&] { followLinks(folder_ / "round"); }).find("ends nowhere"), std::string::npos);
}

TEST_F(FileTest, AFileKeepsItsPermissions) {
  const fs::path path = folder_ / "private";
  writeTextFile(path, "1");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  writeTextFile(path, "2");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(readFile(path), "2");
}

TEST_F(FileTest, WhatAKillLeftIsCollectedAndNothingElse) {
  const std::string ended = std::to_string(endedProcess()), alive = std::to_string(::getppid());
  const auto put = [&](const std::string& name) { std::ofstream(folder_ / name) << "half"; };
  put(".gnomon-" + ended + "-0.tmp");
  fs::create_directories(folder_ / (".gnomon-" + ended + "-1.tmp") / "spot");
  put(".gnomon-" + ended + "-1.tmp/spot/a.png");
  const std::vector<std::string> kept = {".gnomon-" + alive + "-0.tmp", ".gnomon-" + ended + "-2.tmp",
                                         ".gnomon-notes.tmp", ".gnomon-" + ended + "-3.tmp.txt", "gnomon.tmp"};
  for (const std::string& name : kept) put(name);
  // Of a process on another machine, say: alive if held.
  const Descriptor held(::open((folder_ / kept[1]).c_str(), O_RDONLY));
  ASSERT_EQ(::flock(held.get(), LOCK_EX), 0);
  writeTextFile(folder_ / "file", "");
  for (const std::string& name : kept) EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  EXPECT_EQ(fileCount(), kept.size() + 1);
}

TEST_F(FileTest, FoldersAreMadeAndBytesKept) {
  const std::string bytes("a\0b\r\n", 5);
  writeTextFile(folder_ / "a" / "b" / "c.bin", bytes);
  EXPECT_EQ(readFile(folder_ / "a" / "b" / "c.bin"), bytes);
}

TEST_F(FileTest, WhatCannotBeReadOrWrittenIsNamed) {
  EXPECT_NE(messageOf([&] { readFile(folder_ / "absent"); }).find("absent: cannot be read"), std::string::npos);
  EXPECT_NE(messageOf([&] { readFile(folder_); }).find("is a folder"), std::string::npos);
  EXPECT_NE(messageOf([&] { writeTextFile(folder_, ""); }).find("is a folder"), std::string::npos);
  EXPECT_NE(messageOf([&] { writeTextFile("", ""); }).find("is empty"), std::string::npos);
  writeTextFile(folder_ / "file", "12345");
  EXPECT_NE(messageOf([&] { writeTextFile(folder_ / "file" / "below", ""); }).find("file: cannot"), std::string::npos);
  EXPECT_NE(messageOf([&] { checkOutput(folder_ / "file" / "below"); }).find("not a folder"), std::string::npos);
  EXPECT_NE(messageOf([&] { readFile(folder_ / "file", 4); }).find("more than 4 bytes"), std::string::npos);
  EXPECT_EQ(readFile(folder_ / "file", 5), "12345");
  EXPECT_NE(messageOf([&] { readFile("/dev/zero"); }).find("/dev/zero: is a device"), std::string::npos);
  writeTextFile(folder_ / "long", std::string(100'001, 'x'));
  EXPECT_NE(messageOf([&] { readFile(folder_ / "long", 100'000); }).find("more than 100000 bytes"), std::string::npos);
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_NE(messageOf([&] { readRegularFile(folder_ / "pipe"); }).find("is no regular file"), std::string::npos);
  checkOutput(folder_ / "new" / "below");
  EXPECT_FALSE(fs::exists(folder_ / "new"));
}

}  // namespace
}  // namespace gnomon
