#pragma once
// Reads shaders as trees (syntax.h): preprocesses, and parses what the dialect of shaders/shared/ has
// (docs/shared_glsl.md). Interface blocks, layouts and other bindings are passed over.

#include "lab/export/syntax.h"

#include "gpu/shader_compiler.h"

#include <map>
#include <set>

namespace gnomon::code {

struct ReadOptions {
  std::set<std::string> defined;               // macros that are taken as defined, and as nothing
  std::map<std::string, std::string> aliases;  // macros without arguments
  bool publicMembers = false;                  // of GNOMON_PUBLIC_ONLY
};

// Throws WorldError that names file and line where something is not understood.
Program readGlsl(const gpu::ShaderSource& source, const ReadOptions& options);

}  // namespace gnomon::code
