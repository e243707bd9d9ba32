#include "cli/memory_limit.h"

#include "base/file.h"
#include "base/interrupt.h"
#include "base/sanitizers.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include <fmt/format.h>

namespace gnomon {

namespace {

rlim_t addressLimit() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

std::string readAll(int descriptor) {
  constexpr size_t kMost = 1 << 20;
  std::string text;
  std::array<char, 4096> some{};
  while (true) {
    const ssize_t count = ::read(descriptor, some.data(), some.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    if (text.size() < kMost) text.append(some.data(), static_cast<size_t>(count));
  }
}

// A line of Gnomon's that does not take a library that finds no memory for one that is not there, or for a broken file.
bool isOwnComplaint(const std::string& said) {
  return said.starts_with("gnomon: ") && std::count(said.begin(), said.end(), '\n') == 1 &&
         said.find("install") == std::string::npos && said.find(".so") == std::string::npos &&
         said.find("bad_alloc") == std::string::npos;
}

// Without memory of its own.
void tellOutOfMemory() {
  std::array<char, 256> line{};
  const int length = std::snprintf(line.data(), line.size(),
                                   "gnomon: out of memory: ulimit -v allows %llu MiB, and a small picture takes about "
                                   "1500; raise it, or take a smaller scene or --size\n",
                                   static_cast<unsigned long long>(addressLimit() >> 20));
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), static_cast<size_t>(length));
}

#if !GNOMON_HAS_SANITIZERS  // whose own beginning comes first
// Before the libraries' own beginnings: some make threads there, and no exception of theirs can be caught.
void beginWithinMemoryLimit(int, char**, char**) {
  if (!isMemoryLimited()) return;
  std::set_terminate([] {
    tellOutOfMemory();
    ::_exit(1);
  });
}
[[gnu::section(".preinit_array"), gnu::used]] void (*const kBegin)(int, char**, char**) = beginWithinMemoryLimit;
#endif

}  // namespace

bool isMemoryLimited() {
  return addressLimit() != RLIM_INFINITY;
}

int runWithinMemoryLimit(const std::function<int()>& work) {
  const auto outOfMemory = [] {
    tellOutOfMemory();
    return 1;
  };
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return outOfMemory();
  const Descriptor heard(ends[0]);
  Descriptor said(ends[1]);
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) return outOfMemory();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::dup2(said.get(), STDERR_FILENO);
    const int exitCode = work();
    std::fflush(nullptr);
    ::_exit(exitCode);  // not by way of destructors of libraries, which may ask for memory
  }
  said = Descriptor();
  std::signal(SIGINT, SIG_IGN);  // a terminal sends it to both, and the child answers
  const std::string text = readAll(heard.get());
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) return 128 + SIGINT;
  const int exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (exitCode != 0 && exitCode != 2 && exitCode != 3 && exitCode != kInterruptedExitCode && !isOwnComplaint(text))
    return outOfMemory();
  std::fputs(text.c_str(), stderr);
  return exitCode;
}

}  // namespace gnomon
