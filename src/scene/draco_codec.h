#pragma once
// The part of the glTF loader that calls libdraco, in a library of its own, loaded when the first compressed mesh is
// read: Debian's libdraco brings a tinygltf of another layout under the same names. For gltf_draco.cpp only.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

struct DracoMesh {
  struct Attribute {
    uint32_t id = 0;  // as glTF names it: Draco's unique id
    int components = 0;
    std::vector<float> values;  // `components` a point
  };
  std::vector<uint32_t> corners;  // points, three a triangle
  std::vector<Attribute> attributes;
};

struct DracoCodec {
  // Empty, or what is wrong with the bytes.
  std::string (*decode)(const unsigned char* bytes, size_t size, DracoMesh& mesh);
};

inline constexpr const char* kDracoCodecLibrary = "libgnomon_draco.so";
inline constexpr const char* kDracoCodecSymbol = "gnomonDracoCodec";

}  // namespace gnomon
