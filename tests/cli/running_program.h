#pragma once
// The program in a process that a test can send a signal to.

#include "base/file.h"

#include "tests/base/places.h"

#include <fcntl.h>
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
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    process_ = ::fork();
    if (process_ != 0) return;
    std::signal(SIGINT, SIG_DFL);  // whatever the test was started by has made of it
    const auto open = [&](const char* name) {
      return ::open((folder_ / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    };
    ::dup2(open("stdout"), STDOUT_FILENO);
    ::dup2(open("stderr"), STDERR_FILENO);
    if (::chdir(folder_.c_str()) == 0) ::execv(words[0].c_str(), argv.data());
    ::_exit(127);
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
