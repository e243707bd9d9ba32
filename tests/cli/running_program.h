#pragma once
// The program in a process that a test can send a signal to.

#include "base/file.h"

#include "tests/base/places.h"
#include "tests/base/started_process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace gnomon::test {

class RunningProgram {
 public:
  // What it prints goes to files in `folder`, which it runs in.
  RunningProgram(std::vector<std::string> words, const std::filesystem::path& folder) : folder_(folder) {
    words.insert(words.begin(), test::inBuild("gnomon"));
    const Descriptor out = openToWrite(folder_ / "stdout"), error = openToWrite(folder_ / "stderr");
    process_ = startProcess(std::move(words), {.out = out.get(), .error = error.get(), .folder = folder_});
  }
  ~RunningProgram() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  // Until `isThere`; false after two minutes, or where the program has ended.
  bool waitUntil(const std::function<bool()>& isThere) {
    for (int i = 0; i < 2400; ++i) {
      if (isThere()) return true;
      int status = 0;
      if (::waitpid(process_, &status, WNOHANG) == process_) {
        process_ = -1;
        ADD_FAILURE() << "ended early: " << readFile(folder_ / "stderr");
        return false;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ADD_FAILURE() << "nothing in two minutes: " << readFile(folder_ / "stderr");
    return false;
  }

  // Sends a signal; the exit code, or minus the signal that ended it.
  int end(int signal) {
    ::kill(process_, signal);
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  std::filesystem::path folder_;
  pid_t process_ = -1;
};

}  // namespace gnomon::test
