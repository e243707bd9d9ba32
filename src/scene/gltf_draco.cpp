#include "scene/gltf_draco.h"

#include "base/error.h"
#include "base/message.h"
#include "scene/draco_codec.h"

#include <dlfcn.h>

#include <algorithm>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace gnomon {

namespace {

constexpr const char* kRemedy = "decompress it first, as with `gltf-transform copy`";

const DracoCodec& dracoCodec() {
  static const DracoCodec& codec = []() -> const DracoCodec& {
    void* library = ::dlopen(kDracoCodecLibrary, RTLD_NOW | RTLD_LOCAL);
    const void* symbol = library == nullptr ? nullptr : ::dlsym(library, kDracoCodecSymbol);
    if (symbol == nullptr)
      throw fileError(kDracoCodecLibrary, ::dlerror(),
                      "it decompresses meshes: keep it where the build or the installation put it");
    return *static_cast<const DracoCodec*>(symbol);
  }();
  return codec;
}

}  // namespace

std::optional<DracoPrimitive> unpackDraco(GltfDocument& document, const tinygltf::Primitive& primitive,
                                          const std::string& where) {
  const auto extension = primitive.extensions.find("KHR_draco_mesh_compression");
  if (extension == primitive.extensions.end()) return std::nullopt;
  const std::span<const unsigned char> packed =
      document.viewBytes(extension->second.Get("bufferView").GetNumberAsInt());
  DracoMesh mesh;
  const std::string wrong = dracoCodec().decode(packed.data(), packed.size(), mesh);
  if (!wrong.empty()) document.refuse(where + ": its Draco bytes are damaged: " + oneLine(wrong), kRemedy);

  DracoPrimitive unpacked{.corners = std::move(mesh.corners), .attributes = {}};
  const tinygltf::Value& ids = extension->second.Get("attributes");
  for (const std::string& name : ids.Keys()) {
    const auto accessor = primitive.attributes.find(name);
    const uint32_t id = static_cast<uint32_t>(ids.Get(name).GetNumberAsInt());
    const auto attribute = std::ranges::find(mesh.attributes, id, &DracoMesh::Attribute::id);
    if (accessor == primitive.attributes.end() || attribute == mesh.attributes.end()) continue;
    unpacked.attributes.emplace(name,
                                AccessorView(accessor->second, attribute->components, std::move(attribute->values)));
  }
  return unpacked;
}

}  // namespace gnomon
