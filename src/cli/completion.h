#pragma once
// Shell completion and the manual page, made from the flags as they are declared.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gnomon {

const std::vector<std::string>& completionShells();  // bash, zsh, fish

// A script for one of them that completes verbs, flags, and the values that are declared (offers.h). `program`: the app
// with its verbs.
std::string completionScript(const CLI::App& program, const std::string& shell);

// gnomon(1), as troff with the man macros.
std::string manualPage(const CLI::App& program, const std::string& version);

}  // namespace gnomon
