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
//   - GLSL ES 3.00: doubles, functions of later versions, and their forms for whole numbers;
//   - HLSL and Metal: types, functions and numbers without a translation; comparisons of what is no number; vectors of
//     one value, and of more than they hold; the letters stpq; mix by a bool; constructors of structures but in a
//     declaration; a variable's name in what it begins with, or a function's that has another name there;
//   - Metal: out arguments that are components, of another type or one variable twice; numbers of several types in one
//     call, and a structure's of other types than its own; numbers where functions take vectors, and the bits of
//     vectors; arrays as values; constants that call functions;
//   - HLSL: what writes to a variable to the right of &&, || and ?, which it always evaluates; structures in ?;
//     products of matrices; findLSB but as an int; cases with statements before another case that do not end in break
//     or return.
std::optional<Untranslated> firstUntranslated(const Program& program, Language language);

}  // namespace gnomon::code
