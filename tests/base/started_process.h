#pragma once
// A program in a process of its own. Not by fork: a copy of this process has every lock that another thread holds at
// that moment, the allocator's of a sanitizer among them, and libraries start threads before main.

#include "base/file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace gnomon::test {

// What a process has in place of this one's: descriptors, and the folder that it runs in.
struct Started {
  int in = STDIN_FILENO, out = STDOUT_FILENO, error = STDERR_FILENO;
  std::filesystem::path folder = {};
};

// The process, to be waited for; -1, and a failure, where there is none. `words`: the program, then its arguments.
// Signals do there what they do by default.
inline pid_t startProcess(std::vector<std::string> words, const Started& started = {}) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, started.in, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, started.out, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, started.error, STDERR_FILENO);
  if (!started.folder.empty()) ::posix_spawn_file_actions_addchdir_np(&actions, started.folder.c_str());
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t all;
  sigfillset(&all);
  ::posix_spawnattr_setsigdefault(&attributes, &all);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  pid_t process = -1;
  const int error = ::posix_spawn(&process, words.at(0).c_str(), &actions, &attributes, argv.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error == 0) return process;
  ADD_FAILURE() << words[0] << ": " << std::strerror(error);
  return -1;
}

// As waitpid has it.
inline int statusOf(pid_t process) {
  int status = -1;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

// A file to write into, emptied, that no other process inherits.
inline Descriptor openToWrite(const std::filesystem::path& path) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  EXPECT_TRUE(file.isOpen()) << path;
  return file;
}

}  // namespace gnomon::test
