#include "gpu/glsl_comments.h"

#include <string_view>

namespace gnomon::gpu {

namespace {

bool isBreak(char c) {
  return c == '\n' || c == '\r';
}

// How long the line break at the beginning is; 0: there is none.
size_t breakLength(std::string_view text) {
  if (text.empty() || !isBreak(text[0])) return 0;
  return text.starts_with("\r\n") ? 2 : 1;
}

// How long the comment at the beginning is, without the line break that ends it; 0: there is none.
size_t commentLength(std::string_view text) {
  if (text.starts_with("/*")) {
    const size_t end = text.find("*/", 2);
    return end == std::string_view::npos ? text.size() : end + 2;
  }
  size_t length = 0;
  if (text.starts_with("//"))
    while (length < text.size() && !isBreak(text[length]))
      length += text[length] == '\\' ? 1 + breakLength(text.substr(length + 1)) : 1;
  return length;
}

}  // namespace

std::string blankComments(std::string glsl, CommentBreaks breaks) {
  for (size_t i = 0; i < glsl.size();) {
    const size_t length = commentLength(std::string_view(glsl).substr(i));
    for (const size_t end = i + length; i < end; ++i)
      if (breaks == CommentBreaks::Blanked || !isBreak(glsl[i])) glsl[i] = ' ';
    if (length == 0) ++i;
  }
  return glsl;
}

}  // namespace gnomon::gpu
