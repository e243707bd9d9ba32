#include "base/message.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

// The bytes of the UTF-8 character at the front (Unicode 15, table 3-7), 0 where there is none.
size_t utf8Length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [&](size_t i, unsigned least = 0x80, unsigned most = 0xbf) {
    return byte(i) >= least && byte(i) <= most;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return follows(1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef)
    return follows(1, first == 0xe0 ? 0xa0 : 0x80, first == 0xed ? 0x9f : 0xbf) && follows(2) ? 3 : 0;
  if (first >= 0xf0 && first <= 0xf4)
    return follows(1, first == 0xf0 ? 0x90 : 0x80, first == 0xf4 ? 0x8f : 0xbf) && follows(2) && follows(3) ? 4 : 0;
  return 0;
}

// C0, DEL, and C1, which UTF-8 writes as c2 80 .. c2 9f.
bool isControl(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return first < 0x20 || first == 0x7f;
  return character.size() == 2 && first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0;
}

std::string escaped(std::string_view bytes) {
  if (bytes == "\n") return "\\n";
  if (bytes == "\t") return "\\t";
  if (bytes == "\r") return "\\r";
  std::string out;
  for (const char c : bytes) out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  return out;
}

bool isContinuation(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const size_t length = utf8Length(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    out += length == 0 || isControl(character) ? escaped(character) : std::string(character);
    text.remove_prefix(character.size());
  }
  return out;
}

std::string oneLine(std::string_view text, size_t most) {
  text = text.substr(0, text.find('\n'));
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.remove_suffix(1);
  // What is left out need not be escaped first: a byte becomes at least one.
  const bool isLong = text.size() > 2 * most;
  std::string line =
      isLong ? printable(text.substr(0, most)) + printable(text.substr(text.size() - most)) : printable(text);
  if (line.size() <= most) return line;
  // The beginning says where, the end how to go on.
  constexpr std::string_view kGap = " ... ";
  size_t front = (most - kGap.size()) * 2 / 3, back = line.size() - (most - kGap.size() - front);
  while (front > 0 && isContinuation(line[front])) --front;
  while (back < line.size() && isContinuation(line[back])) ++back;
  return line.substr(0, front) + std::string(kGap) + line.substr(back);
}

}  // namespace gnomon
