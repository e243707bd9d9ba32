#pragma once
// KHR_draco_mesh_compression: the attributes and indices of one primitive, unpacked. Internal to the loader.

#include "scene/gltf_accessor.h"

#include <optional>
#include <vector>

namespace tinygltf {
struct Primitive;
}

namespace gnomon {

struct DracoPrimitive {
  std::vector<uint32_t> corners;  // three a triangle
  // The attributes of `primitive` that Draco holds, by their glTF names.
  std::map<std::string, AccessorView> attributes;
};

// Nothing where the primitive is not compressed. Throws WorldError.
std::optional<DracoPrimitive> unpackDraco(GltfDocument& document, const tinygltf::Primitive& primitive,
                                          const std::string& where);

}  // namespace gnomon
