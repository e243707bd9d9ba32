// The other side of child.cpp: the process in which the work is done.
#include "base/child.h"
#include "base/child_channel.h"
#include "base/process_memory.h"
#include "base/sandbox.h"
#include "base/sanitizers.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

namespace gnomon {

namespace {

constexpr bool kLimitsMemory = !kHasSanitizers;

void limit(__rlimit_resource resource, rlim_t soft) {
  rlimit both{};
  ::getrlimit(resource, &both);
  both.rlim_cur = std::min(soft, both.rlim_cur);
  ::setrlimit(resource, &both);
}

// In place of `Begun`. Ends the process without the destructors of libraries, which a damaged file may have got at.
[[noreturn]] void handOver(ChildOutcome outcome, const std::string& bytes) {
  const char kind = static_cast<char>(outcome);
  const bool isWhole =
      ::lseek(kChildResult, 0, SEEK_SET) == 0 && writeAll(kChildResult, {&kind, 1}) && writeAll(kChildResult, bytes);
  ::_exit(isWhole ? 0 : 1);
}

bool isFile(int descriptor) {
  struct stat status = {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

bool writeAll(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<size_t>(count));
  }
  return true;
}

std::string readAll(int descriptor) {
  struct stat status = {};
  ::fstat(descriptor, &status);
  std::string bytes(static_cast<size_t>(status.st_size), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::pread(descriptor, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

int runAsChild(int argc, char** argv, std::initializer_list<std::pair<std::string_view, ChildFunction>> works) {
  ChildLimits limits;
  unsigned long long most = 0;
  int usesFiles = 0, parent = 0;
  const auto* const found =
      std::ranges::find_if(works, [&](const auto& work) { return argc > 2 && work.first == argv[1]; });
  if (found == works.end() || !isFile(kChildInput) || !isFile(kChildResult) ||
      std::sscanf(argv[2], "%llu %d %d %d", &most, &limits.seconds, &usesFiles, &parent) != 4) {
    std::fputs("gnomon starts this program itself, to read what may be damaged; run gnomon\n", stderr);
    return 2;
  }
  // Sanitizers catch these and end with an exit code, which tells less.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) return 1;  // it ended before that
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds));
  if (kLimitsMemory) limit(RLIMIT_AS, processMemory().addressSpace + most);
  const char begun = static_cast<char>(ChildOutcome::Begun);
  if (!writeAll(kChildResult, {&begun, 1})) return 1;
  try {
    std::string input = readAll(kChildInput);
    ::close(kChildInput);
    if (usesFiles == 0) enterSandbox(kChildResult);  // where there is none, the limits hold still
    handOver(ChildOutcome::Done, found->second({argv + 3, argv + argc}, std::move(input)));
  } catch (const std::bad_alloc&) {
    handOver(ChildOutcome::OutOfMemory, "");
  } catch (const std::exception& error) {
    handOver(ChildOutcome::Failed, error.what());
  } catch (...) {
    handOver(ChildOutcome::Failed, "an error that has no text");
  }
}

}  // namespace gnomon
