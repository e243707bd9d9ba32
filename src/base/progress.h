#pragma once
// A progress line on stderr if that is a terminal; silent in a pipe and with --quiet.

#include <string>

namespace gnomon {

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
};

}  // namespace gnomon
