#pragma once
// The subcommands of the program, each in its own file; verbs.cpp has the list. main catches WorldError and UsageError.

#include <functional>
#include <vector>

namespace CLI {
class App;
}

namespace gnomon {

// Called once the command line is parsed; returns the exit code.
using Run = std::function<int()>;

struct Verb {
  const char* name;
  const char* sentence;        // for --help
  Run (*add)(CLI::App* verb);  // adds its flags
};

// In the order of --help.
const std::vector<Verb>& verbs();

}  // namespace gnomon
