#include "base/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

namespace gnomon {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal handler may set it

void remember(int signal) {
  constexpr std::string_view kSaid = "\ngnomon: interrupted; writing what is done (once more to stop at once)\n";
  interrupted = true;
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kSaid.data(), kSaid.size());
  std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  struct sigaction action = {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction old = {};
    // What a parent has told to ignore stays ignored (nohup, a shell's background jobs).
    if (::sigaction(signal, nullptr, &old) == 0 && old.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
  }
}

InterruptGuard::~InterruptGuard() {
  interrupted = false;
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction old = {};
    if (::sigaction(signal, nullptr, &old) == 0 && old.sa_handler == remember) std::signal(signal, SIG_DFL);
  }
}

bool isInterrupted() {
  return interrupted;
}

void throwIfInterrupted() {
  if (isInterrupted()) throw Interrupted();
}

}  // namespace gnomon
