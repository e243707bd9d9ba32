// What a child breaks, fills or never finishes is an error of one line.
#include "base/child.h"
#include "base/error.h"
#include "base/file.h"
#include "base/sandbox.h"
#include "base/sanitizers.h"
#include "tests/base/temporary_folder.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

constexpr ChildLimits kLimits{.bytes = 256 << 20, .seconds = 1};

std::string messageOf(const std::function<std::string()>& work) {
  try {
    runInChild("file.x", kLimits, work);
  } catch (const WorldError& error) {
    return error.what();
  }
  return "";
}

TEST(ChildTest, HandsOverWhatItMakes) {
  EXPECT_EQ(runInChild("file.x", kLimits, [] { return std::string(); }), "");
  const std::string large(50'000'000, 'x');
  EXPECT_EQ(runInChild("file.x", kLimits, [&] { return large; }), large);
}

TEST(ChildTest, ItsErrorsAreTheCallers) {
  EXPECT_EQ(messageOf([]() -> std::string { throw WorldError("file.x: no; yes"); }), "file.x: no; yes");
  EXPECT_EQ(messageOf([]() -> std::string { throw std::runtime_error("odd"); }), "odd");
}

TEST(ChildTest, ACrashNamesTheFileAndPrintsNothing) {
  testing::internal::CaptureStderr();
  const std::string message = messageOf([]() -> std::string {
    std::fputs("a library's last words\n", stderr);
    std::fflush(stderr);
    std::raise(SIGSEGV);
    return "";
  });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(message.find("file.x: is damaged: it crashes its reader (Segmentation fault)"), std::string::npos)
      << message;
}

// What damage in a file may make a library do: nothing of it reaches beyond the child.
TEST(ChildTest, ItCanOpenStartSignalAndConnectNothing) {
  const auto failureOf = [](const std::function<long()>& call) {
    const std::string message = messageOf([&]() -> std::string {
      errno = 0;
      const long given = call();
      throw WorldError(given < 0 ? std::strerror(errno) : "done");
    });
    return message;
  };
  const std::string refused = std::strerror(EPERM);
  const test::TemporaryFolder folder;
  const std::string made = (folder.path() / "by_a_child").string();
  EXPECT_EQ(failureOf([&] { return ::open(made.c_str(), O_CREAT | O_WRONLY, 0600); }), refused);
  EXPECT_EQ(failureOf([] { return ::open("/etc/passwd", O_RDONLY); }), refused);
  EXPECT_EQ(failureOf([] { return ::socket(AF_INET, SOCK_STREAM, 0); }), refused);
  EXPECT_EQ(failureOf([] { return ::fork(); }), refused);
  EXPECT_EQ(failureOf([] { return ::kill(::getppid(), 0); }), refused);
  EXPECT_EQ(failureOf([] { return ::unlink("/nowhere"); }), refused);
  EXPECT_EQ(failureOf([] {
              void* page = ::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
              return page == MAP_FAILED ? -1 : 0;
            }),
            refused);
  if (!kHasSanitizers) {  // which write into pipes of their own
    const Descriptor other(::memfd_create("other", MFD_CLOEXEC));
    EXPECT_EQ(failureOf([&] { return ::write(other.get(), "x", 1); }), refused);
  }
  EXPECT_FALSE(std::filesystem::exists(made));
}

TEST(ChildTest, ItEndsInTimeWhetherItWorksOrWaits) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_NE(messageOf([]() -> std::string {
              for (std::atomic<int> i = 0;; ++i) {
              }
            }).find("file.x: takes more than 1 s"),
            std::string::npos);
  EXPECT_NE(messageOf([] {
              std::this_thread::sleep_for(std::chrono::seconds(60));
              return std::string();
            }).find("file.x: takes more than 1 s"),
            std::string::npos);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

TEST(ChildTest, ItHasNoMoreMemoryThanItIsGiven) {
  if (kHasSanitizers) GTEST_SKIP() << "skipped: sanitizers take terabytes of addresses";
  const std::string message = messageOf([] { return std::string(size_t{1} << 30, 'x'); });
  EXPECT_NE(message.find("file.x: takes more than 256 MiB of memory"), std::string::npos) << message;
}

}  // namespace
}  // namespace gnomon
