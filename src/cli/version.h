#pragma once
// What this program was built from, for --version and bug reports.

#include <string>

namespace gnomon {

// "gnomon 0.1.0 (v0.1-12-gabc1234)", then a line each: compiler and options, libraries, Vulkan's headers.
std::string versionText();

}  // namespace gnomon
