#pragma once
// The two kinds of error that a user can fix. Both carry one line, with what is wrong and how to fix it. Only main
// catches them; it prints the line and returns the exit code.

#include <stdexcept>
#include <string>

namespace gnomon {

// The world failed: a file, a device, memory. Exit code 1.
struct WorldError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The command line was wrong. Exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// "path: what is wrong; remedy", the form every message about a file has.
[[nodiscard]] WorldError fileError(const std::string& path, const std::string& what, const std::string& remedy);

}  // namespace gnomon
