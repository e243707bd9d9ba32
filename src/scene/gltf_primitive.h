#pragma once
// One glTF primitive as a Mesh. Internal to the loader.

#include "scene/gltf_document.h"
#include "scene/scene.h"

#include <optional>

namespace tinygltf {
struct Primitive;
}

namespace gnomon {

// How a material's base-colour texture reads its uvs: which set, and KHR_texture_transform as uv' = m * (u, v, 1).
struct UvSource {
  bool read = false;  // whether there is a texture at all
  int set = 0;
  glm::dmat3 transform{1.0};
};

// Triangles, strips and fans become indexed triangles; vertices that no triangle uses are left out; where the file has
// no normals there are none, and triangles are flat, as glTF prescribes. Nothing for points and lines. `where` names
// the primitive in messages. Mesh space; `closed` and `material` are left to the caller.
std::optional<Mesh> loadPrimitive(GltfDocument& document, const tinygltf::Primitive& primitive,
                                  const UvSource& uvSource, const std::string& where);

// The alpha of COLOR_0, which multiplies a material's; 1 where there is none. Refused where it varies over the
// primitive: holes that vertices make are not read.
float vertexAlpha(GltfDocument& document, const tinygltf::Primitive& primitive, const std::string& where);

}  // namespace gnomon
