#pragma once
// Ctrl-C during long work that can leave what is done: the work asks now and then whether to end.

#include <stdexcept>

namespace gnomon {

// Out of work that has nothing to show yet, to whoever has.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

inline constexpr int kInterruptedExitCode = 130;  // as of a shell, for a program that SIGINT ended

// As long as one lives, the first SIGINT or SIGTERM is remembered and told, and the second ends the program as ever.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
};

bool isInterrupted();       // from any thread
void throwIfInterrupted();  // Interrupted

}  // namespace gnomon
