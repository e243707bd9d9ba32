#include "scene/gltf_extensions.h"

#include "base/error.h"
#include "base/message.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

using enum ExtensionUse;

constexpr GltfExtension kExtensions[] = {
    {"KHR_lights_punctual", Read, "but for a light's range, which is told: light reaches on"},
    {"KHR_texture_transform", Read, "of the base colour"},
    {"KHR_mesh_quantization", Read, ""},
    {"KHR_node_visibility", Read, "hidden nodes cast no shadow and shine no light"},
    {"KHR_materials_pbrSpecularGlossiness", Read, "its diffuse colour is the base colour, its alpha makes the holes"},
    {"KHR_draco_mesh_compression", Read, ""},
    {"EXT_meshopt_compression", Read, ""},
    {"EXT_mesh_gpu_instancing", Read, ""},
    {"KHR_materials_transmission", Told, "lets light through, but casts an opaque shadow here"},
    {"KHR_materials_volume", Told, "lets light through, but casts an opaque shadow here"},
    {"KHR_materials_diffuse_transmission", Told, "lets light through, but casts an opaque shadow here"},
    {"EXT_lights_ies", Told, "shapes a light's power by direction; it shines evenly here"},
    {"KHR_texture_basisu", Fallback, ""},
    {"EXT_texture_webp", Fallback, ""},
    {"EXT_texture_avif", Fallback, ""},
    {"MSFT_texture_dds", Fallback, ""},
    {"KHR_techniques_webgl", Refused, "export it with metallic-roughness materials"},
    {"KHR_gaussian_splatting*", Refused, "name a file with meshes of triangles"},
    {"KHR_meshopt_compression", Refused,
     "decompress it first, as with `gltf-transform copy`, or pack it as EXT_meshopt_compression"},
    {"MSFT_lod", Told, "offers other levels of detail; the first one is drawn"},
    {"KHR_materials_variants", Told, "offers other materials; each mesh's own one is used"},
    {"KHR_materials_*", Harmless, ""},
    {"KHR_animation_pointer", Harmless, ""},
    {"KHR_node_hoverability", Harmless, ""},
    {"KHR_node_selectability", Harmless, ""},
    {"KHR_interactivity*", Harmless, ""},
    {"KHR_implicit_shapes", Harmless, ""},
    {"KHR_physics_rigid_bodies", Harmless, ""},
    {"KHR_audio*", Harmless, ""},
    {"KHR_xmp*", Harmless, ""},
    {"KHR_xmp_json_ld", Harmless, ""},
    {"EXT_lights_image_based", Harmless, ""},
    {"EXT_mesh_features", Harmless, ""},
    {"EXT_mesh_manifold", Harmless, ""},
    {"EXT_instance_features", Harmless, ""},
    {"EXT_structural_metadata", Harmless, ""},
    {"CESIUM_primitive_outline", Harmless, ""},
    {"MSFT_packing_*", Harmless, ""},
    {"VRM*", Harmless, ""},
};

bool matches(std::string_view pattern, std::string_view name) {
  if (!pattern.ends_with('*')) return pattern == name;
  return name.starts_with(pattern.substr(0, pattern.size() - 1));
}

std::vector<std::string> namesIn(const nlohmann::json& document, const char* list, const std::string& fileName) {
  const auto it = document.find(list);
  if (it == document.end()) return {};
  if (!it->is_array()) throw fileError(fileName, fmt::format("'{}' is not an array", list), "export the file again");
  std::vector<std::string> names;
  for (const nlohmann::json& entry : *it)
    names.push_back(oneLine(entry.is_string() ? entry.get<std::string>() : entry.dump()));
  return names;
}

}  // namespace

std::span<const GltfExtension> gltfExtensions() {
  return kExtensions;
}

const GltfExtension* findGltfExtension(std::string_view name) {
  const auto it = std::ranges::find_if(kExtensions, [&](const GltfExtension& e) { return matches(e.name, name); });
  return it == std::end(kExtensions) ? nullptr : it;
}

ExtensionNotes checkExtensions(const nlohmann::json& document, const std::string& fileName) {
  for (const std::string& name : namesIn(document, "extensionsRequired", fileName)) {
    const GltfExtension* known = findGltfExtension(name);
    if (known && known->use != Refused) continue;
    throw fileError(fileName, fmt::format("requires the extension {}, which Gnomon does not read", name),
                    known ? std::string(known->sentence) : "export it without this extension");
  }
  ExtensionNotes told;
  std::vector<std::string> harmless;
  for (const std::string& name : namesIn(document, "extensionsUsed", fileName)) {
    const GltfExtension* known = findGltfExtension(name);
    if (!known)
      told.notes.push_back(fmt::format("extension {} is unknown to Gnomon, and passed over", name));
    else if (known->use == Told)
      told.notes.push_back(fmt::format("extension {} {}", name, known->sentence));
    else if (known->use == Refused)
      told.notes.push_back(fmt::format("extension {} is passed over; {}", name, known->sentence));
    else if (known->use == Harmless)
      harmless.push_back(name);
  }
  if (!harmless.empty())
    told.harmless.push_back(
        fmt::format("extensions passed over, since they cannot change a shadow: {}", fmt::join(harmless, ", ")));
  return told;
}

}  // namespace gnomon
