#pragma once
// GLSL to SPIR-V at run time: embedded sources (or --shader-dir to edit them live), #include resolved from
// the shaders folder, glslang in process, SPIR-V kept on disk under the hash of the expanded source.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace gnomon::gpu {

// Where sources come from; the embedded ones unless set. Throws WorldError where it is no folder.
void setShaderDirectory(const std::filesystem::path& folder);
std::filesystem::path shaderDirectory();  // empty: the embedded ones

// Where SPIR-V and pipeline caches live: $GNOMON_CACHE_DIR, else $XDG_CACHE_HOME/gnomon, else ~/.cache/gnomon; an empty
// GNOMON_CACHE_DIR turns the cache off. A cache that cannot be written is passed over.
std::filesystem::path cacheDirectory();

struct ShaderSource {
  std::string path;  // "shadow/shade_visibility.comp.glsl", below the shaders folder; the stage is in the name
  // Replaces or adds files for the #include resolver: a user's own bias, a test's variant.
  std::map<std::string, std::string> overrides;
  bool operator==(const ShaderSource&) const = default;
};

// Source with its #includes expanded, each file at most once, with #line directives that keep file names
// (GL_GOOGLE_cpp_style_line_directive), so that an error message names file and line. Throws WorldError.
std::string expandShader(const ShaderSource& source);

// Throws WorldError with glslang's own message: "shadow/x.comp.glsl:12: ...".
std::vector<uint32_t> compileShader(const ShaderSource& source);

// How many shaders this process compiled, and how many it found in the cache.
struct ShaderCacheCounts {
  int compiled = 0;
  int found = 0;
};
ShaderCacheCounts shaderCacheCounts();

}  // namespace gnomon::gpu
