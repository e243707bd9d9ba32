#pragma once
// Text that others wrote (a file's names, a library's complaint), made fit for a terminal, a log and a page.

#include <string>
#include <string_view>

namespace gnomon {

// The most bytes of a message about what went wrong.
inline constexpr size_t kLongestMessage = 300;

// Control characters as escapes (\n, \x1b), so that no name moves the cursor or begins a line; UTF-8 stays, and of what
// is no UTF-8 each byte is an escape too.
std::string printable(std::string_view text);

// The first line, printable, without full stops and space at its end; beyond `most` bytes its middle is left out.
std::string oneLine(std::string_view text, size_t most = kLongestMessage);

}  // namespace gnomon
