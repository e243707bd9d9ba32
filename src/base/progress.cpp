#include "base/progress.h"

#include <unistd.h>

#include <cstdio>

namespace gnomon {

namespace {
bool quietMode = false;
}

Progress::Progress(std::string what, int stepCount)
    : what_(std::move(what)), stepCount_(stepCount), visible_(!quietMode && ::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (visible_) std::fprintf(stderr, "\r\x1b[K");
}

void Progress::step(const std::string& detail) {
  ++done_;
  if (!visible_) return;
  std::fprintf(stderr, "\r\x1b[K%s %d/%d  %s", what_.c_str(), done_, stepCount_, detail.c_str());
  std::fflush(stderr);
}

void Progress::setQuiet(bool quiet) {
  quietMode = quiet;
}

}  // namespace gnomon
