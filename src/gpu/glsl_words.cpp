#include "gpu/glsl_words.h"

#include "gpu/glsl_comments.h"

#include <algorithm>
#include <cctype>

namespace gnomon::gpu {

namespace {

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

}  // namespace

bool isWordLetter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

size_t lengthOfWord(std::string_view text) {
  if (text.empty()) return 0;
  const bool number = isDigit(text[0]) || (text[0] == '.' && text.size() > 1 && isDigit(text[1]));
  if (!number && !isWordLetter(text[0])) return 0;
  size_t length = 1;
  while (length < text.size()) {
    const char c = text[length], last = text[length - 1];
    const bool exponentSign =
        number && (c == '+' || c == '-') && (last == 'e' || last == 'E') && !text.starts_with("0x");
    if (!isWordLetter(c) && !(number && c == '.') && !exponentSign) break;
    ++length;
  }
  return length;
}

std::vector<Word> wordsOf(const std::string& glsl) {
  const std::string code = blankComments(glsl);
  std::vector<Word> words;
  int line = 1;
  for (size_t i = 0; i < code.size();) {
    const size_t length = std::max<size_t>(1, lengthOfWord(std::string_view(code).substr(i)));
    if (std::isspace(static_cast<unsigned char>(code[i])) == 0)
      words.push_back({.text = code.substr(i, length), .line = line});
    line += code[i] == '\n' ? 1 : 0;
    i += length;
  }
  return words;
}

}  // namespace gnomon::gpu
