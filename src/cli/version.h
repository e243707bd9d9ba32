#pragma once
// What this program was built from, for --version and bug reports.

#include <string>

namespace gnomon {

// "gnomon 0.1.0 (v0.1-12-gabc1234)", then a line each: compiler and options, libraries, Vulkan's headers.
std::string versionText();

// "0.1.0 (abc1234)"; of a program that is not what was committed also a hash of itself: "0.1.0 (abc1234-dirty 9f...)".
std::string programText();

}  // namespace gnomon
