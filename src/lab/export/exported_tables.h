#pragma once
// The textures and buffers that exported code reads, and the functions that read them, in each language.

#include "lab/export/print_code.h"

#include <string>
#include <vector>

namespace gnomon::code {

struct Table {
  const char* function;  // of unbound_visibility.glsl or lookup_tables.glsl, where it is declared and no more
  const char* name;      // "gnomonDepth"
  const char* member;    // of Metal's GnomonTextures
  bool isMap;            // slices of the map; else rows of a table
  bool isDepthFormat;
  const char* component;  // "float", "uint"
  int components;
  const char* holds;
};

const std::vector<Table>& tables();

// Of a table's texture or buffer.
std::string declaration(Language language, const Table& table, int binding);

// Of its function. `decl`: the shaders' declaration; `names`: what things are called when printed; `program`: has the
// structure that the function returns, of whose members only those that are read are left.
std::string definition(Language language, const Table& table, const PrintOptions& names, const Decl& decl,
                       const Program& program);

}  // namespace gnomon::code
