#include "base/terminal.h"

#include "base/error.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace gnomon {

namespace {

bool isGivenAway = false;
int firstFailure = 0;  // errno

void note(bool written) {
  if (!written && firstFailure == 0) firstFailure = errno != 0 ? errno : EIO;
}

}  // namespace

void guardStandardStreams() {
  // The wrong way round, so that a closed standard output is still one that cannot be written.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) == -1 && errno == EBADF)
      ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  // A reader that has gone and a file that has grown to its limit are failed writes like others, not the end.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void say(std::string_view text) {
  std::FILE* stream = isGivenAway ? stderr : stdout;
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  if (!isGivenAway) note(written);
}

void giveStandardOutputAway() {
  isGivenAway = true;
}

void finishStandardOutput() {
  errno = 0;
  note(std::fflush(stdout) == 0);
  if (std::ferror(stdout) != 0) note(false);
  if (firstFailure != 0)
    throw fileError("standard output", "cannot be written, part of it is lost", std::strerror(firstFailure));
}

}  // namespace gnomon
