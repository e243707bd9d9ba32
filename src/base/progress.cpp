#include "base/progress.h"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

namespace gnomon {

namespace {
bool quietMode = false;

// Of work, before it is told how long the rest takes: a shorter one is over before it is read.
constexpr double kLeastSeconds = 2.0;
}  // namespace

std::string remainingText(double seconds, int done, int count) {
  if (done < 1 || done >= count || seconds < kLeastSeconds) return "";
  const double left = seconds * (count - done) / done;
  if (left < 90.0) return fmt::format("about {:.0f} s left", left);
  if (left < 90.0 * 60.0) return fmt::format("about {:.0f} min left", left / 60.0);
  return fmt::format("about {:.1f} h left", left / 3600.0);
}

Progress::Progress(std::string what, int stepCount)
    : what_(std::move(what)),
      stepCount_(stepCount),
      visible_(!quietMode && ::isatty(STDERR_FILENO) == 1),
      begun_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (visible_) std::fprintf(stderr, "\r\x1b[K");
}

void Progress::step(const std::string& detail) {
  ++done_;
  if (!visible_) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  const std::string left = remainingText(seconds, done_ - 1, stepCount_);
  std::fprintf(stderr, "\r\x1b[K%s %d/%d  %s%s%s", what_.c_str(), done_, stepCount_, detail.c_str(),
               left.empty() ? "" : "  ", left.c_str());
  std::fflush(stderr);
}

void Progress::setQuiet(bool quiet) {
  quietMode = quiet;
}

}  // namespace gnomon
