#pragma once
// GLSL as words.

#include <string>
#include <string_view>
#include <vector>

namespace gnomon::gpu {

bool isWordLetter(char c);
// Of the name or number that the text begins with; 0 where it begins with neither.
size_t lengthOfWord(std::string_view text);

// A name, a number or a character of anything else but blanks.
struct Word {
  std::string text;
  int line = 1;

  bool isName() const { return lengthOfWord(text) > 0; }
};

// Without comments.
std::vector<Word> wordsOf(const std::string& glsl);

}  // namespace gnomon::gpu
