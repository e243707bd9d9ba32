#include "cli/wrap.h"

#include "base/parse.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>

namespace gnomon {

size_t terminalWidth() {
  constexpr size_t kLeast = 40;  // below which nothing fits
  if (const char* columns = std::getenv("COLUMNS")) {
    const auto number = parseNumber(columns);
    if (number && *number >= kLeast && *number < 1e6) return static_cast<size_t>(*number);
  }
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < kLeast) return 0;
  return size.ws_col;
}

std::string wrapped(const std::string& text, size_t width) {
  if (width == 0) return text;
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    while (line.size() > width) {
      const size_t at = line.rfind(' ', width);
      if (at == std::string::npos || at <= line.find_first_not_of(' ')) break;
      out += line.substr(0, at) + "\n";
      line = "    " + line.substr(at + 1);
    }
    out += line + "\n";
  }
  return out;
}

}  // namespace gnomon
