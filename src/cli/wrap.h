#pragma once
// The width of the terminal, kept by what is printed on it.

#include <string>

namespace gnomon {

// Letters of a line of stdout: COLUMNS where it is set, else the terminal's; 0 where stdout is none: no limit.
size_t terminalWidth();

// Lines of at most `width` letters, broken at spaces; what is carried over is indented by four. 0: as it is.
std::string wrapped(const std::string& text, size_t width);

}  // namespace gnomon
