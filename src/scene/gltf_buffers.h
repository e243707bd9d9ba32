#pragma once
// The files and data: URIs that a glTF names, and compressed bufferViews. Internal to the loader.

#include "scene/gltf.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

// The bytes that a URI stands for: a data: URI (any type and case; base64 or percent-encoded), or a file in `folder`
// or one of `options.allowedFolders`. `what` names it in messages ("buffer 2"). Throws WorldError: nothing absolute, no
// way out of those folders (symbolic links are followed before asking), no device.
std::string bytesOfUri(const std::string& uri, const std::string& what, const std::string& fileName,
                       const std::filesystem::path& folder, const GltfOptions& options);

// RFC 3986: %xx is a byte, and everything else stands for itself, '+' and a stray '%' too.
std::string percentDecoded(std::string_view text);

// EXT_meshopt_compression: how a bufferView's elements are packed.
struct MeshoptView {
  std::string mode, filter;  // ATTRIBUTES, TRIANGLES, INDICES; NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL
  size_t count = 0, stride = 0;
};

// count * stride bytes. Throws std::runtime_error with what is wrong.
std::vector<unsigned char> unpackMeshopt(const MeshoptView& view, std::span<const unsigned char> packed);

}  // namespace gnomon
