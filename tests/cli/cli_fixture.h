#pragma once
// The program as a person runs it: its exit code and what it prints, in a folder of the test's own.

#include "base/file.h"
#include "tests/base/places.h"
#include "tests/base/temporary_folder.h"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace gnomon::test {

struct Result {
  int exitCode = -1;
  std::string out;
  std::string err;
};

class CliTest : public ::testing::Test {
 protected:
  // `@` at the start of a word or a value stands for this test's folder.
  Result run(std::string arguments) const {
    for (size_t at = arguments.find('@'); at != std::string::npos; at = arguments.find('@', at + 1))
      if (at == 0 || std::string_view(" ='\":,").find(arguments[at - 1]) != std::string_view::npos)
        arguments.replace(at, 1, folder_.string());
    const std::string command = test::inBuild("gnomon") + " " + arguments + " >" + (folder_ / "stdout").string() +
                                " 2>" + (folder_ / "stderr").string() + " </dev/null";
    const int status = std::system(command.c_str());
    Result result{.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
                  .out = readFile(folder_ / "stdout"),
                  .err = readFile(folder_ / "stderr")};
    std::filesystem::remove(folder_ / "stdout");
    std::filesystem::remove(folder_ / "stderr");
    return result;
  }

  // Exit code, and a single line on stderr that holds `what`.
  void expectMistake(const std::string& arguments, int exitCode, const std::string& what) const {
    const Result result = run(arguments);
    EXPECT_EQ(result.exitCode, exitCode) << arguments << "\n" << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << arguments << "\n" << result.err;
  }

  size_t fileCount() const {
    return static_cast<size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
};

}  // namespace gnomon::test
