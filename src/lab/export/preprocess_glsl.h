#pragma once
// The first half of reading a shader (read_glsl.h): its lines as tokens, with directives obeyed and macros replaced, as
// far as the dialect of shaders/shared/ has them (docs/shared_glsl.md).

#include "lab/export/read_glsl.h"

#include <cctype>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gnomon::code {

struct Token {
  std::string text;
  std::vector<std::string> before;  // comment lines right above
  std::string after;                // comment on the same line
  std::string file;
  int line = 0;

  bool isName() const { return std::isalpha(static_cast<unsigned char>(text[0])) != 0 || text[0] == '_'; }
};

struct Tokens {
  std::vector<Token> tokens;
  std::vector<std::pair<std::string, std::vector<std::string>>> heads;  // Program::heads
};

bool isWordLetter(char c);
// Of the name or number that the text begins with; 0 where it begins with neither.
size_t lengthOfWord(std::string_view text);

// `text`: of gpu::expandShader. Throws WorldError that names file and line.
Tokens preprocessGlsl(const std::string& text, const ReadOptions& options);

}  // namespace gnomon::code
