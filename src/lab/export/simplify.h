#pragma once
// Partial evaluation of a program (syntax.h): with some names known, branches that they decide go, and with them what
// nothing uses any more: functions, parameters, members, variables, constants. Arithmetic stays as it is.
//
// What goes relies on how the shaders of shaders/ are written (docs/shared_glsl.md): conditions and values without side
// effects, names that mean one thing, numbers of one type. A user's file need not be, and stays as it is written, but
// for names that stand for others and for parameters of Gnomon's types that it does not read.

#include "lab/export/syntax.h"

#include <map>
#include <set>

namespace gnomon::code {

struct Known {
  // Names and paths ("kMethod", "tables.instanced") whose values decide branches. Booleans are 0 and 1.
  std::map<std::string, double> values;
  // Names and paths that stand for other expressions ("map.width" for "kMapSide").
  std::map<std::string, std::string> replacements;
  // Variables that are only written to, in statements and parameters that go.
  std::set<std::string> unread;
  std::vector<std::string> roots;  // functions that stay
  std::string userFile;            // Decl::file of what stays as it is written
};

void simplify(Program& program, const Known& known);

}  // namespace gnomon::code
