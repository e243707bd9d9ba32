#pragma once
// The command line as it was typed, for reports.

#include <string>
#include <vector>

namespace gnomon {

void setCommandLine(int argc, char** argv);

// Quoted for a shell.
std::string commandLine();
// Its words, the program's name first.
const std::vector<std::string>& typedWords();

}  // namespace gnomon
