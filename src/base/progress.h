#pragma once
// A progress line on stderr if that is a terminal; silent in a pipe and with --quiet.

#include <chrono>
#include <string>

namespace gnomon {

// "about 40 s left", "about 12 min left", "about 3 h left"; empty before there is anything to judge by. `done` steps of
// `count` took `seconds`, and those to come are taken to be like them.
std::string remainingText(double seconds, int done, int count);

class Progress {
 public:
  // Total number of steps; the line shows once the work has lasted longer than a blink.
  Progress(std::string what, int stepCount);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // One step begins; `detail` says which.
  void step(const std::string& detail);

  static void setQuiet(bool quiet);

 private:
  std::string what_;
  int stepCount_ = 0;
  int done_ = 0;
  bool visible_ = false;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace gnomon
