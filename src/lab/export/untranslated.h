#pragma once
// What of a user's bias another language lacks, or would take for something else.

#include "lab/export/print_code.h"

#include <optional>
#include <string>

namespace gnomon::code {

struct Untranslated {
  int line = 0;      // of the user's file; 0: where `word` first stands
  std::string word;  // a type
  std::string message;
};

// The first there is; nothing where all of it can be printed in the language. `program`: with the user's file in it.
//   - GLSL ES 3.00: doubles, and functions of later versions;
//   - HLSL and Metal: types, functions and numbers without a translation; comparisons of what is no number; vectors of
//     one value; constructors of structures but in a declaration; a variable's name in what it begins with;
//   - Metal: out arguments that are components or one variable twice; floats and whole numbers in one call;
//   - HLSL: what writes to a variable to the right of &&, || and ?, which it always evaluates; products of matrices.
std::optional<Untranslated> firstUntranslated(const Program& program, Language language);

}  // namespace gnomon::code
