#pragma once
// Compiles exported files: GLSL, GLSL ES and HLSL by glslang. Apple's compiler there is none here, but Metal is C++14:
// parsed by the C++ compiler, with a stand-in for its library.

#include "lab/export/print_code.h"

#include <string>

namespace gnomon::test {

// How the file's functions are called: by the names in its head.
std::string calls(const std::string& text, const char* pixel, const char* place, const char* normal);

// Errors; empty where it compiles. In any language but Metal.
std::string compiled(code::Language language, const std::string& text);

// Of what the C++ compiler parses.
std::string metalErrors(const std::string& text);

}  // namespace gnomon::test
