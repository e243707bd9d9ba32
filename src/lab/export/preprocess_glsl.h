#pragma once
// The first half of reading a shader (read_glsl.h): its lines as tokens, with directives obeyed and macros replaced, as
// far as the dialect of shaders/shared/ has them (docs/shared_glsl.md).

#include "lab/export/macro_expansion.h"
#include "lab/export/read_glsl.h"

#include <string>
#include <utility>
#include <vector>

namespace gnomon::code {

struct Tokens {
  std::vector<Token> tokens;
  std::vector<std::pair<std::string, std::vector<std::string>>> heads;  // Program::heads
};

// `text`: of gpu::expandShader. Throws WorldError that names file and line.
Tokens preprocessGlsl(const std::string& text, const ReadOptions& options);

}  // namespace gnomon::code
