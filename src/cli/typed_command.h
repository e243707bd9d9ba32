#pragma once
// The command line as it was typed, for reports.

#include <string>

namespace gnomon {

void setCommandLine(int argc, char** argv);

// Quoted for a shell.
std::string commandLine();

}  // namespace gnomon
