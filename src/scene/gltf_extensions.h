#pragma once
// What Gnomon does with each glTF extension: reads it, refuses files that need it, or passes over it because it cannot
// change a shadow. docs/gltf.md has the table as text. Internal to the loader.

#include "scene/gltf_document.h"

#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace gnomon {

enum class ExtensionUse {
  Read,      // honoured in full
  Harmless,  // passed over: it cannot change a shadow
  Told,      // passed over, but a shadow may differ for it: `sentence` says how
  Fallback,  // a texture of a kind that Gnomon does not decode; told where it is used without a PNG or JPEG
  Refused,   // `sentence` is the remedy
};

struct GltfExtension {
  std::string_view name;  // or how it begins, where it ends in '*'
  ExtensionUse use = ExtensionUse::Harmless;
  std::string_view sentence;
};

// Every extension that Gnomon knows of.
std::span<const GltfExtension> gltfExtensions();

// Null for one that nobody has told Gnomon of.
const GltfExtension* findGltfExtension(std::string_view name);

// What to tell of a file's "extensionsUsed". Throws WorldError if "extensionsRequired" names one that is refused or
// unknown.
struct ExtensionNotes {
  std::vector<std::string> notes, harmless;
};
ExtensionNotes checkExtensions(const nlohmann::json& document, const std::string& fileName);

}  // namespace gnomon
