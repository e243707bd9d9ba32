#include "cli/typed_command.h"

#include "base/parse.h"

namespace gnomon {

namespace {

std::string typed;

}  // namespace

void setCommandLine(int argc, char** argv) {
  typed = "gnomon";
  for (int i = 1; i < argc; ++i) typed += " " + shellWord(argv[i]);
}

std::string commandLine() {
  return typed;
}

}  // namespace gnomon
