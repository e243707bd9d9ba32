#include "cli/typed_command.h"

#include "base/parse.h"

namespace gnomon {

namespace {

std::vector<std::string> words;

}  // namespace

void setCommandLine(int argc, char** argv) {
  words.assign(argv, argv + argc);
}

std::string commandLine() {
  std::string line = "gnomon";
  for (size_t i = 1; i < words.size(); ++i) line += " " + shellWord(words[i]);
  return line;
}

const std::vector<std::string>& typedWords() {
  return words;
}

}  // namespace gnomon
