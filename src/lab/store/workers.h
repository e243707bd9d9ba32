#pragma once
// Which of the processes that work on one store are alive: each holds a lock on a byte of its own in the file
// STORE-workers (open file description locks, fcntl(2)), which the kernel gives back however a process ends.

#include "base/file.h"

#include <cstdint>
#include <filesystem>

namespace gnomon {

class Workers {
 public:
  // Of the store at this path, on this machine.
  explicit Workers(const std::filesystem::path& store);
  // The last one alive removes the file.
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  // From now on this process is the worker of this number, at least 1. False where another is already.
  bool become(int64_t number);
  // Whether another process is that worker.
  bool isAlive(int64_t number) const;
  // Whether any process has the store open for work, on this machine.
  static bool anyAt(const std::filesystem::path& store);

 private:
  std::filesystem::path path_;
  Descriptor file_;
};

}  // namespace gnomon
