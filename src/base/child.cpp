#include "base/child.h"

#include "base/child_channel.h"
#include "base/error.h"
#include "base/file.h"
#include "base/interrupt.h"
#include "base/program_place.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include <fmt/format.h>

namespace gnomon {

namespace {

// What a terminal sends to both: this process answers it, and the child goes with it.
constexpr int kAnswersTo[] = {SIGINT, SIGHUP, SIGTERM, SIGQUIT};

// Above those that the child has them as, so that none takes another's place.
Descriptor aboveTheChilds(int descriptor) {
  return Descriptor(::fcntl(descriptor, F_DUPFD_CLOEXEC, kChildDescriptors));
}

class Actions {
 public:
  Actions() { ::posix_spawn_file_actions_init(&actions_); }
  ~Actions() { ::posix_spawn_file_actions_destroy(&actions_); }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;

  void give(const Descriptor& descriptor, int as) {
    ::posix_spawn_file_actions_adddup2(&actions_, descriptor.get(), as);
  }
  void closeOthers() { ::posix_spawn_file_actions_addclosefrom_np(&actions_, kChildDescriptors); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

class Attributes {
 public:
  Attributes() {
    ::posix_spawnattr_init(&attributes_);
    sigset_t defaults, blocked;
    sigfillset(&defaults);
    sigemptyset(&blocked);
    for (const int signal : kAnswersTo) sigaddset(&blocked, signal);
    ::posix_spawnattr_setsigdefault(&attributes_, &defaults);
    ::posix_spawnattr_setsigmask(&attributes_, &blocked);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~Attributes() { ::posix_spawnattr_destroy(&attributes_); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

enum class Ending { OfItsOwn, OutOfTime, Interrupted };

// How the child ends, which closes its end of the pipe. Looks up now and then: a signal may come to another thread.
Ending endingOf(int pipe, int seconds) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + std::chrono::seconds(seconds);
  while (true) {
    if (isInterrupted()) return Ending::Interrupted;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return Ending::OutOfTime;
    pollfd ended{.fd = pipe, .events = POLLIN, .revents = 0};
    constexpr long long kLooks = 100;  // milliseconds
    if (::poll(&ended, 1, static_cast<int>(std::min<long long>(left, kLooks))) > 0) return Ending::OfItsOwn;
  }
}

}  // namespace

std::string runInChild(const ChildWork& work, const ChildLimits& limits) {
  const auto noProcess = [&](const std::string& why) {
    return fileError(work.file, "is to be read in a process of its own, which cannot be made", why);
  };
  const std::string program = findProgram(work.program);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw noProcess(std::strerror(errno));
  const Descriptor ended(ends[0]);
  Descriptor held(ends[1]);
  const bool isFile = work.inputFile >= 0;
  const Descriptor input(isFile ? ::fcntl(work.inputFile, F_DUPFD_CLOEXEC, 0)
                                : ::memfd_create("gnomon-input", MFD_CLOEXEC));
  const Descriptor result(::memfd_create("gnomon-result", MFD_CLOEXEC));
  const Descriptor nowhere(::open("/dev/null", O_RDWR | O_CLOEXEC));
  Descriptor heldByChild = aboveTheChilds(held.get());
  const Descriptor inputOfChild = aboveTheChilds(input.get()), resultOfChild = aboveTheChilds(result.get()),
                   nowhereOfChild = aboveTheChilds(nowhere.get());
  if (!heldByChild.isOpen() || !inputOfChild.isOpen() || !resultOfChild.isOpen() || !nowhereOfChild.isOpen())
    throw noProcess(std::strerror(errno));
  if (!isFile && !writeAll(input.get(), work.input)) throw noProcess(std::strerror(errno));

  Actions actions;
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) actions.give(nowhereOfChild, stream);
  actions.give(inputOfChild, kChildInput);
  actions.give(resultOfChild, kChildResult);
  actions.give(heldByChild, kChildHeld);
  actions.closeOthers();
  std::vector<std::string> words{
      program, work.name,
      fmt::format("{} {} {} {}", limits.bytes, limits.seconds, limits.usesFiles ? 1 : 0, ::getpid())};
  words.insert(words.end(), work.arguments.begin(), work.arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  if (const int error = ::posix_spawn(&child, program.c_str(), actions.get(), Attributes().get(), argv.data(), environ))
    throw noProcess(std::strerror(error));
  held = Descriptor();
  heldByChild = Descriptor();

  const Ending ending = endingOf(ended.get(), 4 * limits.seconds);
  if (ending != Ending::OfItsOwn) ::kill(child, SIGKILL);
  int status = 0;
  pid_t waited = 0;
  do waited = ::waitpid(child, &status, 0);
  while (waited < 0 && errno == EINTR);
  if (ending == Ending::Interrupted) throw Interrupted();
  const std::string bytes = readAll(result.get());
  const auto isEndedBy = [&](int signal) { return WIFSIGNALED(status) && WTERMSIG(status) == signal; };
  if (ending == Ending::OutOfTime || isEndedBy(SIGXCPU))
    throw fileError(work.file, fmt::format("takes more than {} s to read", limits.seconds),
                    "use a smaller or simpler one");
  if (bytes.empty())
    throw noProcess(fmt::format("{} ends before it begins: there may be too little memory", work.program));
  if (isEndedBy(SIGKILL))
    throw fileError(work.file, fmt::format("its reader, {}, was killed", work.program),
                    "there may be too little memory");
  if (WIFSIGNALED(status))
    throw fileError(work.file, fmt::format("is damaged: it crashes its reader ({})", ::strsignal(WTERMSIG(status))),
                    "use another file");
  // Where this process ignores SIGCHLD nobody is told how another ended.
  if (waited < 0 && bytes.front() == static_cast<char>(ChildOutcome::Begun))
    throw fileError(work.file, fmt::format("{} ended without an answer", work.program), "use another file");
  const auto outcome = WEXITSTATUS(status) == 0 ? static_cast<ChildOutcome>(bytes.front()) : ChildOutcome::OutOfMemory;
  if (outcome == ChildOutcome::Done) return bytes.substr(1);
  if (outcome == ChildOutcome::Failed) throw WorldError(bytes.substr(1));
  throw fileError(work.file, fmt::format("takes more than {} MiB of memory to read", limits.bytes >> 20),
                  "use a smaller or simpler one");
}

}  // namespace gnomon
