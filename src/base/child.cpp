#include "base/child.h"

#include "base/error.h"
#include "base/file.h"
#include "base/process_memory.h"
#include "base/sandbox.h"
#include "base/sanitizers.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <new>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr bool kLimitsMemory = !kHasSanitizers;

// The first byte of what the child hands over.
enum class Outcome : char { Done = 'D', Failed = 'F', OutOfMemory = 'M' };

void limit(__rlimit_resource resource, rlim_t soft) {
  rlimit both{};
  ::getrlimit(resource, &both);
  both.rlim_cur = std::min(soft, both.rlim_cur);
  ::setrlimit(resource, &both);
}

bool writeAll(int descriptor, const char* bytes, size_t size) {
  while (size > 0) {
    const ssize_t count = ::write(descriptor, bytes, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

[[noreturn]] void handOver(int result, Outcome outcome, const std::string& bytes) {
  const char kind = static_cast<char>(outcome);
  const bool whole = writeAll(result, &kind, 1) && writeAll(result, bytes.data(), bytes.size());
  ::_exit(whole ? 0 : 1);
}

[[noreturn]] void runAsChild(int result, const ChildLimits& limits, const std::function<std::string()>& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, SIG_DFL);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds));
  if (kLimitsMemory) limit(RLIMIT_AS, processMemory().addressSpace + limits.bytes);
  if (!limits.usesFiles) enterSandbox(result);  // where there is none, the limits hold still
  try {
    handOver(result, Outcome::Done, work());
  } catch (const std::bad_alloc&) {
    handOver(result, Outcome::OutOfMemory, "");
  } catch (const std::exception& error) {
    handOver(result, Outcome::Failed, error.what());
  } catch (...) {
    handOver(result, Outcome::Failed, "an error that has no text");
  }
}

// Whether the child has ended, which closes its end of the pipe, in time.
bool endsInTime(int pipe, int seconds) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + std::chrono::seconds(seconds);
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd ended{.fd = pipe, .events = POLLIN, .revents = 0};
    const int count = ::poll(&ended, 1, static_cast<int>(std::max<long long>(left, 0)));
    if (count < 0 && errno == EINTR) continue;
    return count > 0;
  }
}

std::string bytesOf(int memory) {
  struct stat status = {};
  ::fstat(memory, &status);
  std::string bytes(static_cast<size_t>(status.st_size), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::pread(memory, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (count <= 0) break;
    done += static_cast<size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace

std::string runInChild(const std::string& name, const ChildLimits& limits, const std::function<std::string()>& work) {
  const auto noProcess = [&] {
    return fileError(name, "is to be read in a process of its own, which cannot be made", std::strerror(errno));
  };
  const Descriptor result(::memfd_create("gnomon", MFD_CLOEXEC));
  std::array<int, 2> ends{};
  if (!result.isOpen() || ::pipe2(ends.data(), O_CLOEXEC) != 0) throw noProcess();
  const Descriptor ended(ends[0]);
  Descriptor held(ends[1]);
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw noProcess();
  if (child == 0) runAsChild(result.get(), limits, work);
  held = Descriptor();
  const bool inTime = endsInTime(ended.get(), 4 * limits.seconds);
  if (!inTime) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool isOutOfTime = !inTime || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU);
  if (isOutOfTime)
    throw fileError(name, fmt::format("takes more than {} s to read", limits.seconds), "use a smaller or simpler one");
  if (WIFSIGNALED(status))
    throw fileError(name, fmt::format("is damaged: it crashes its reader ({})", ::strsignal(WTERMSIG(status))),
                    "use another file");
  const std::string bytes = WEXITSTATUS(status) == 0 ? bytesOf(result.get()) : "";
  const auto outcome = bytes.empty() ? Outcome::OutOfMemory : static_cast<Outcome>(bytes.front());
  if (outcome == Outcome::Failed) throw WorldError(bytes.substr(1));
  if (outcome == Outcome::OutOfMemory)
    throw fileError(name, fmt::format("takes more than {} MiB of memory to read", limits.bytes >> 20),
                    "use a smaller or simpler one");
  return bytes.substr(1);
}

}  // namespace gnomon
