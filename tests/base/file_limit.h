#pragma once
// A disk that is full after so many bytes of a file: the kernel's limit on a file's size, for as long as it lives.

#include "base/file.h"

#include <sys/resource.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>

#include <gtest/gtest.h>

namespace gnomon::test {

class FileLimit {
 public:
  explicit FileLimit(uint64_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit before_{};
};

// Whatever the byte at which the disk is full: an error, and the old file as it was, alone in its folder.
template <typename Error>
void expectWholeOrOld(const std::filesystem::path& path, const std::function<void()>& write) {
  write();
  const uint64_t size = std::filesystem::file_size(path);
  writeTextFile(path, "old");
  for (uint64_t room = 0; room < size; room += std::max<uint64_t>(size / 64, 1)) {
    {
      const FileLimit limit(room);
      EXPECT_THROW(write(), Error) << room << " of " << size;
    }
    EXPECT_EQ(readFile(path), "old") << room << " of " << size;
    const std::filesystem::directory_iterator begin(path.parent_path());
    EXPECT_EQ(std::distance(begin, std::filesystem::directory_iterator()), 1) << room << " of " << size;
  }
  const FileLimit limit(size);
  write();
  EXPECT_EQ(std::filesystem::file_size(path), size);
}

}  // namespace gnomon::test
