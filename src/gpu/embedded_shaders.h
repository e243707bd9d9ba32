#pragma once
// The shaders folder, embedded as a table of sources by cmake/embed_shaders.cmake.

#include <cstddef>

namespace gnomon::gpu {

struct EmbeddedShader {
  const char* path;  // below shaders/
  const char* text;
};

extern const EmbeddedShader kEmbeddedShaders[];
extern const size_t kEmbeddedShaderCount;

}  // namespace gnomon::gpu
