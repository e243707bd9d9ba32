// What a child breaks, fills or never finishes is an error of one line. child_test_program.cpp has what it does.
#include "base/child.h"
#include "base/error.h"
#include "base/file.h"
#include "base/interrupt.h"
#include "base/program_place.h"
#include "base/sanitizers.h"
#include "tests/base/places.h"
#include "tests/base/temporary_folder.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

const std::string kProgram = test::inBuild("tests/base/child_test_program");
constexpr ChildLimits kLimits{.bytes = 256 << 20, .seconds = 1};

std::string made(const std::string& work, const std::vector<std::string>& arguments = {}, std::string_view input = {},
                 const ChildLimits& limits = kLimits) {
  return runInChild({.file = "file.x", .name = work, .arguments = arguments, .input = input, .program = kProgram},
                    limits);
}

std::string messageOf(const std::string& work, const std::vector<std::string>& arguments = {}) {
  try {
    made(work, arguments);
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

TEST(ChildTest, HandsOverWhatItMakes) {
  EXPECT_EQ(made("echo"), "");
  const std::string large(50'000'000, 'x');
  EXPECT_TRUE(made("echo", {"a word", "", "-"}, large, {.bytes = 512 << 20, .seconds = 20}) == "a word||-|" + large);
  EXPECT_EQ(made("echo", {}, std::string("a\0b", 3)), std::string("a\0b", 3));
}

TEST(ChildTest, ItsErrorsAreTheCallers) {
  EXPECT_EQ(messageOf("complain", {"file.x: no; yes"}), "file.x: no; yes");
  EXPECT_EQ(messageOf("complain oddly", {"odd"}), "odd");
}

TEST(ChildTest, ACrashNamesTheFileAndPrintsNothing) {
  testing::internal::CaptureStderr();
  const std::string message = messageOf("crash");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(message.find("file.x: is damaged: it crashes its reader (Segmentation fault)"), std::string::npos)
      << message;
}

// As by the kernel, where memory ends: the file is not to blame.
TEST(ChildTest, WhereItIsKilledThatIsTold) {
  const ChildLimits limits{.bytes = 256 << 20, .seconds = 5, .usesFiles = true};  // and it may signal
  try {
    made("be killed", {}, {}, limits);
    FAIL();
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("was killed; there may be too little memory"), std::string::npos)
        << error.what();
  }
}

// As some that start programs leave it: then nobody is told how a process ends.
TEST(ChildTest, ItsEndIsSeenWhereNobodyIsToldOfEnds) {
  std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(made("echo", {"word"}), "word|");
  const std::string message = messageOf("crash");
  std::signal(SIGCHLD, SIG_DFL);
  EXPECT_NE(message.find("file.x: "), std::string::npos) << message;
  EXPECT_NE(message.find("ended without an answer"), std::string::npos) << message;
}

TEST(ChildTest, ReadsAFileWhereverItsDescriptorStands) {
  const test::TemporaryFolder folder;
  writeTextFile(folder.path() / "in", "a file's bytes");
  const Descriptor in(::open((folder.path() / "in").c_str(), O_RDONLY));
  ::lseek(in.get(), 3, SEEK_SET);
  EXPECT_EQ(
      runInChild({.file = "in", .name = "echo", .arguments = {}, .inputFile = in.get(), .program = kProgram}, kLimits),
      "a file's bytes");
}

TEST(ChildTest, AnInterruptEndsIt) {
  std::signal(SIGTERM, SIG_DFL);  // whatever the test was started by has made of it
  const InterruptGuard guard;
  std::thread hand([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ::kill(::getpid(), SIGTERM);
  });
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(made("wait", {}, {}, {.bytes = 256 << 20, .seconds = 60}), Interrupted);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
  hand.join();
}

// What damage in a file may make a library do: nothing of it reaches beyond the child.
TEST(ChildTest, ItCanOpenStartSignalAndConnectNothing) {
  const std::string refused = std::strerror(EPERM);
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "by_a_child").string();
  for (const char* call :
       {"make a file", "open a file", "connect", "fork", "signal", "remove a file", "run what it writes"})
    EXPECT_EQ(made("try", {call, file}), refused) << call;
  if (!kHasSanitizers) {  // which write into pipes of their own
    EXPECT_EQ(made("try", {"write elsewhere"}), refused);
  }
  EXPECT_FALSE(std::filesystem::exists(file));
}

// Nor is anything open in it that this process has open.
TEST(ChildTest, ItHasNoDescriptorOfItsParents) {
  std::vector<Descriptor> open;
  for (int i = 0; i < 30; ++i) open.emplace_back(::open("/dev/zero", O_RDONLY));  // on purpose not O_CLOEXEC
  EXPECT_EQ(made("try", {"read elsewhere"}), std::strerror(EBADF));
}

TEST(ChildTest, ItEndsInTimeWhetherItWorksOrWaits) {
  const auto begin = std::chrono::steady_clock::now();
  for (const char* work : {"compute", "wait"})
    EXPECT_NE(messageOf(work).find("file.x: takes more than 1 s"), std::string::npos) << work;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

TEST(ChildTest, ItHasNoMoreMemoryThanItIsGiven) {
  if (kHasSanitizers) GTEST_SKIP() << "skipped: sanitizers take terabytes of addresses";
  const std::string message = messageOf("fill", {"1073741824"});
  EXPECT_NE(message.find("file.x: takes more than 256 MiB of memory"), std::string::npos) << message;
}

// Which at any moment hold locks of the allocator, of the loader, or of a library's own.
TEST(ChildTest, OtherThreadsDoNotHoldItUp) {
  std::atomic<bool> isDone = false;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      while (!isDone) {
        std::vector<std::unique_ptr<std::string>> strings;
        for (size_t size = 1; size < 200; ++size) strings.push_back(std::make_unique<std::string>(size * size, 'x'));
        std::thread([] {}).join();
      }
    });
  for (int i = 0; i < 100; ++i) EXPECT_EQ(made("echo", {}, "abc", {.bytes = 256 << 20, .seconds = 20}), "abc");
  isDone = true;
  for (std::thread& thread : threads) thread.join();
}

TEST(ChildTest, AProgramThatIsMissingOrNotWholeIsNamed) {
  const auto messageWith = [](const std::string& program) {
    try {
      runInChild({.file = "file.x", .name = "echo", .arguments = {}, .program = program}, kLimits);
    } catch (const WorldError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(messageWith("gnomon-no-such-program").find("gnomon-no-such-program: there is no such program; keep it"),
            std::string::npos);
  EXPECT_NE(messageWith("/nowhere/at-all").find("file.x: is to be read in a process of its own, which cannot be made"),
            std::string::npos);
  EXPECT_NE(messageWith("/bin/true").find("/bin/true ends before it begins"), std::string::npos);
}

// Where whoever calls may be told: with a slash it is a path; else beside this program, too.
TEST(ChildTest, ProgramsAreFoundBesideThisOne) {
  EXPECT_EQ(findProgram("/a/path"), "/a/path");
  const std::filesystem::path program = kProgram;
  EXPECT_EQ(findProgram(program.filename().string()), program.string());
}

}  // namespace
}  // namespace gnomon
