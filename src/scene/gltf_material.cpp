#include "scene/gltf_material.h"

#include "base/error.h"
#include "base/image.h"
#include "base/message.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace gnomon {

namespace {

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";

constexpr uint64_t kMaxTexels = uint64_t{1} << 29;  // 2 GiB of RGBA8

// A byte of PNG holds 8 pixels of one bit, deflated 1032 times at best; JPEG stays below that.
constexpr uint64_t kMaxPixelsPerByte = 8 * 1032;

struct Size {
  uint64_t width = 0, height = 0;
};

uint64_t bigEndianAt(const std::string& bytes, size_t offset, int size) {
  uint64_t value = 0;
  for (int i = 0; i < size; ++i) value = value << 8 | static_cast<uint8_t>(bytes[offset + i]);
  return value;
}

// Width and height from the header alone, so that a small file cannot ask for gigabytes. Nothing where there is none.
std::optional<Size> pixelSize(const std::string& bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.size() >= 24)
    return Size{bigEndianAt(bytes, 16, 4), bigEndianAt(bytes, 20, 4)};
  if (!bytes.starts_with("\xff\xd8")) return std::nullopt;
  // JPEG: segments of marker and length, up to a start of frame (C0 to CF, but for C4, C8 and CC).
  for (size_t at = 2; at + 9 < bytes.size();) {
    const uint64_t marker = bigEndianAt(bytes, at, 2), length = bigEndianAt(bytes, at + 2, 2);
    if (marker == 0xffff) {
      ++at;  // a fill byte
      continue;
    }
    if (marker < 0xff01 || length < 2) return std::nullopt;
    const bool frame = marker >= 0xffc0 && marker <= 0xffcf && marker != 0xffc4 && marker != 0xffc8 && marker != 0xffcc;
    if (frame) return Size{bigEndianAt(bytes, at + 7, 2), bigEndianAt(bytes, at + 5, 2)};
    at += 2 + length;
  }
  return std::nullopt;
}

class TextureLoader {
 public:
  TextureLoader(GltfDocument& document, Scene& scene) : document_(document), scene_(scene) {}

  // Adds a glTF texture to the scene. Textures of one image share its texels.
  void load(int texture) {
    const tinygltf::Texture& source = document_.model().textures[texture];
    if (source.source < 0)
      document_.refuse(fmt::format("texture {} has no PNG or JPEG image", texture), remedyFor(source));
    glsl::TextureInfo info = loadImage(source.source);
    applySampler(source.sampler, info);
    textures_.emplace(texture, static_cast<int>(scene_.textures.size()));
    scene_.textures.push_back(info);
  }

  // Index into Scene::textures of a glTF texture that has been loaded.
  int indexOf(int texture) const { return textures_.at(texture); }

  bool has(int texture) const { return textures_.contains(texture); }

 private:
  static std::string remedyFor(const tinygltf::Texture& source) {
    const bool basis = source.extensions.contains("KHR_texture_basisu");
    return basis ? "decompress it first, as with `gltf-transform ktxdecompress`" : "convert it to PNG or JPEG";
  }

  glsl::TextureInfo loadImage(int image) {
    const auto known = images_.find(image);
    if (known != images_.end()) return known->second;
    const std::string bytes = document_.imageBytes(image);
    const std::string what = fmt::format("image {}", image);
    const std::optional<Size> size = pixelSize(bytes);
    if (!size) document_.refuse(what + " is neither PNG nor JPEG", "convert it to one of them");
    const uint64_t pixels = size->width * size->height;
    if (size->width > 16384 || size->height > 16384 || pixels == 0 || pixels > kMaxPixelsPerByte * bytes.size())
      document_.refuse(fmt::format("{} says {} x {} pixels in {} bytes", what, size->width, size->height, bytes.size()),
                       "give an image of 1 to 16384 pixels a side that is whole");
    if (scene_.texels.size() + pixels > kMaxTexels)
      document_.refuse("its textures need more than 2 GiB", "shrink them");
    const Image8 decoded =
        decodeImage(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), document_.name() + ": " + what);
    glsl::TextureInfo info{};
    info.firstTexel = static_cast<uint32_t>(scene_.texels.size());
    info.width = decoded.width;
    info.height = decoded.height;
    if (pixels > scene_.texels.size()) scene_.texels.reserve(scene_.texels.size() + pixels);
    for (size_t i = 0; i < decoded.values.size(); i += 4) {
      const uint8_t* p = decoded.values.data() + i;
      scene_.texels.push_back(static_cast<uint32_t>(p[0]) | static_cast<uint32_t>(p[1]) << 8 |
                              static_cast<uint32_t>(p[2]) << 16 | static_cast<uint32_t>(p[3]) << 24);
    }
    images_.emplace(image, info);
    return info;
  }

  void applySampler(int index, glsl::TextureInfo& info) const {
    info.wrapS = info.wrapT = glsl::kWrapRepeat;
    info.filterMode = glsl::kTexFilterLinear;
    if (index < 0) return;
    const tinygltf::Sampler& sampler = document_.model().samplers[index];
    const auto wrapOf = [&](int wrap) {
      if (wrap == TINYGLTF_TEXTURE_WRAP_REPEAT) return glsl::kWrapRepeat;
      if (wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return glsl::kWrapClamp;
      if (wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return glsl::kWrapMirror;
      document_.refuse(fmt::format("sampler {} has the unknown wrapping {}", index, wrap), kRemedy);
    };
    info.wrapS = wrapOf(sampler.wrapS);
    info.wrapT = wrapOf(sampler.wrapT);
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) info.filterMode = glsl::kTexFilterNearest;
  }

  GltfDocument& document_;
  Scene& scene_;
  std::map<int, int> textures_;
  std::map<int, glsl::TextureInfo> images_;
};

// KHR_texture_transform: uv' = translation * rotation * scale * uv, with a rotation that turns v towards -u.
UvSource uvSourceOf(const tinygltf::TextureInfo& info) {
  UvSource source;
  source.read = info.index >= 0;
  source.set = info.texCoord;
  const auto it = info.extensions.find("KHR_texture_transform");
  if (it == info.extensions.end()) return source;
  const tinygltf::Value& value = it->second;
  const auto pairOf = [&](const char* name, glm::dvec2 fallback) {
    if (!value.Has(name)) return fallback;
    const tinygltf::Value& pair = value.Get(name);
    return glm::dvec2(pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble());
  };
  const glm::dvec2 offset = pairOf("offset", {0.0, 0.0}), scale = pairOf("scale", {1.0, 1.0});
  const double rotation = value.Has("rotation") ? value.Get("rotation").GetNumberAsDouble() : 0.0;
  if (value.Has("texCoord")) source.set = value.Get("texCoord").GetNumberAsInt();
  const double c = std::cos(rotation), s = std::sin(rotation);
  source.transform = glm::dmat3(glm::dvec3(c * scale.x, -s * scale.x, 0.0), glm::dvec3(s * scale.y, c * scale.y, 0.0),
                                glm::dvec3(offset, 1.0));
  return source;
}

Material materialOf(GltfDocument& document, const tinygltf::Material& source, int index) {
  Material material;
  material.name = source.name;
  const std::vector<double>& factor = source.pbrMetallicRoughness.baseColorFactor;
  for (int c = 0; c < 4 && factor.size() == 4; ++c) {
    if (!(factor[c] >= 0.0 && factor[c] <= 1.0))
      document.refuse(fmt::format("material {}: baseColorFactor holds {}", index, factor[c]),
                      "use numbers from 0 to 1");
    material.baseColor[c] = static_cast<float>(factor[c]);
  }
  material.doubleSided = source.doubleSided;
  if (source.alphaMode == "MASK") {
    material.alphaMode = AlphaMode::Mask;
    if (!(source.alphaCutoff >= 0.0 && source.alphaCutoff <= 1e6))
      document.refuse(fmt::format("material {}: alphaCutoff is {}", index, source.alphaCutoff),
                      "use a number from 0 to 1");
    material.alphaCutoff = static_cast<float>(source.alphaCutoff);
  } else if (source.alphaMode == "BLEND") {
    material.alphaMode = AlphaMode::Mask;
    document.notes.push_back(fmt::format(
        "material {} '{}' is alpha-blended; its shadow is that of a mask: whole where alpha is at least {}, a "
        "hole below",
        index, oneLine(source.name), material.alphaCutoff));
  } else if (source.alphaMode != "OPAQUE") {
    document.refuse(fmt::format("material {} has the unknown alphaMode '{}'", index, oneLine(source.alphaMode)),
                    kRemedy);
  }
  return material;
}

}  // namespace

std::vector<UvSource> loadMaterials(GltfDocument& document, Scene& scene) {
  const std::vector<tinygltf::Material>& sources = document.model().materials;
  // Those that are used, in the file's order: a saved scene gets its textures back under the same numbers. Where alpha
  // makes holes a texture must be read; elsewhere a colour stands in for one that cannot be.
  std::map<int, bool> mustRead;
  for (const tinygltf::Material& source : sources)
    if (source.pbrMetallicRoughness.baseColorTexture.index >= 0)
      mustRead[source.pbrMetallicRoughness.baseColorTexture.index] |= source.alphaMode != "OPAQUE";
  TextureLoader textures(document, scene);
  for (const auto& [texture, must] : mustRead) {
    try {
      textures.load(texture);
    } catch (const WorldError& error) {
      if (must) throw;
      std::string_view what = error.what();
      if (what.starts_with(document.name() + ": ")) what.remove_prefix(document.name().size() + 2);
      document.notes.push_back(fmt::format("{}; drawn in one colour, which changes no shadow", oneLine(what)));
    }
  }

  std::vector<UvSource> uvSources;
  for (size_t i = 0; i < sources.size(); ++i) {
    Material material = materialOf(document, sources[i], static_cast<int>(i));
    const tinygltf::TextureInfo& texture = sources[i].pbrMetallicRoughness.baseColorTexture;
    if (textures.has(texture.index)) material.baseColorTexture = textures.indexOf(texture.index);
    uvSources.push_back(uvSourceOf(texture));
    scene.materials.push_back(std::move(material));
  }
  return uvSources;
}

}  // namespace gnomon
