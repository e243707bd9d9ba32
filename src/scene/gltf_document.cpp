#include "scene/gltf_document.h"

#include "base/error.h"
#include "base/message.h"
#include "base/parse_json.h"
#include "scene/gltf_buffers.h"
#include "scene/gltf_check.h"
#include "scene/gltf_extensions.h"

#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";
constexpr uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;
constexpr uint64_t kMostBufferBytes = uint64_t{8} << 30;

// What a file may unfold to: a byte index into a shared strip grows to 108 bytes of flat-shaded triangle; the
// rest is for accessors that several primitives share.
constexpr uint64_t kBytesPerByte = 256;
constexpr uint64_t kBytesAlways = 64 << 20;

static_assert(std::endian::native == std::endian::little, "glTF is little-endian and is read as it lies");

struct Chunks {
  std::string_view json;
  std::optional<std::string_view> binary;
};

uint32_t wordAt(std::string_view bytes, size_t offset) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

// glTF 2.0, section 4: a header of three words, then chunks of length, type and bytes.
Chunks splitGlb(std::string_view bytes, const std::string& name) {
  const auto refuse = [&](const std::string& what) { throw fileError(name, what, kRemedy); };
  if (bytes.size() < 20) refuse(fmt::format("has {} bytes, too few for a .glb header", bytes.size()));
  if (wordAt(bytes, 4) != 2) refuse(fmt::format("is .glb version {}, not 2", wordAt(bytes, 4)));
  if (wordAt(bytes, 8) != bytes.size())
    refuse(fmt::format("says that it has {} bytes, but has {} (cut off?)", wordAt(bytes, 8), bytes.size()));
  Chunks chunks;
  size_t offset = 12;
  for (int index = 0; offset < bytes.size(); ++index) {
    if (bytes.size() - offset < 8) refuse(fmt::format("chunk {} is cut off", index));
    const uint32_t length = wordAt(bytes, offset), type = wordAt(bytes, offset + 4);
    offset += 8;
    if (length > bytes.size() - offset)
      refuse(fmt::format("chunk {} says {} bytes, but {} are left", index, length, bytes.size() - offset));
    if (index == 0 && type != kJsonChunk) refuse("the first chunk is not JSON");
    if (index == 0) chunks.json = bytes.substr(offset, length);
    if (index == 1 && type == kBinChunk) chunks.binary = bytes.substr(offset, length);
    offset += length;
  }
  return chunks;
}

json parseGltfJson(std::string_view text, const std::string& name) {
  try {
    return parseJson<json>(text, {});
  } catch (const WorldError& error) {
    throw fileError(name, error.what(), kRemedy);
  } catch (const json::exception& error) {
    throw fileError(name, "is not valid JSON: " + oneLine(error.what()), kRemedy);
  }
}

// A glTF 2.0 file's specular-glossiness material is drawn with its diffuse colour, whose alpha makes the holes.
void useDiffuseAsBaseColor(json& document) {
  const auto materials = document.find("materials");
  if (materials == document.end() || !materials->is_array()) return;
  for (json& material : *materials) {
    if (!material.is_object() || !material.contains("extensions") || !material["extensions"].is_object()) continue;
    const auto glossy = material["extensions"].find("KHR_materials_pbrSpecularGlossiness");
    if (glossy == material["extensions"].end() || !glossy->is_object()) continue;
    json base = json::object();
    if (glossy->contains("diffuseFactor")) base["baseColorFactor"] = (*glossy)["diffuseFactor"];
    if (glossy->contains("diffuseTexture")) base["baseColorTexture"] = (*glossy)["diffuseTexture"];
    material["pbrMetallicRoughness"] = std::move(base);
  }
}

// A compressed primitive's indices are with its attributes; its accessor for them has no bytes, which tinygltf refuses.
void dropDracoIndices(json& document) {
  const auto meshes = document.find("meshes");
  if (meshes == document.end()) return;
  for (json& mesh : *meshes)
    for (json& primitive : mesh["primitives"])
      if (primitive.contains("extensions") && primitive["extensions"].contains("KHR_draco_mesh_compression"))
        primitive.erase("indices");
}

// tinygltf gets a byte for every buffer: it would read '+' in a URI as a space, know few kinds of data: URI, and read
// any file.
json takeBuffers(json& document) {
  json buffers = json::array();
  const auto it = document.find("buffers");
  if (it == document.end()) return buffers;
  std::swap(*it, buffers);
  for (size_t i = 0; i < buffers.size(); ++i)
    it->push_back({{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}});
  return buffers;
}

std::vector<GltfImage> takeImages(json& document) {
  std::vector<GltfImage> images;
  const auto it = document.find("images");
  if (it == document.end()) return images;
  for (const json& entry : *it) {
    GltfImage image;
    image.name = entry.value("name", "");
    image.uri = entry.value("uri", "");
    image.bufferView = entry.value("bufferView", -1);
    images.push_back(std::move(image));
  }
  document.erase(it);
  return images;
}

}  // namespace

GltfDocument::GltfDocument(std::string_view bytes, std::string name, fs::path folder, GltfOptions options)
    : name_(std::move(name)),
      folder_(std::move(folder)),
      options_(std::move(options)),
      model_(std::make_unique<tinygltf::Model>()) {
  if (bytes.empty()) refuse("is empty", "name a .gltf or .glb file");
  const bool isBinary = bytes.size() >= 4 && wordAt(bytes, 0) == kGlbMagic;
  const Chunks chunks = isBinary ? splitGlb(bytes, name_) : Chunks{bytes, std::nullopt};
  json document = parseGltfJson(chunks.json, name_);
  if (document.is_object()) {
    ExtensionNotes told = checkExtensions(document, name_);
    notes = std::move(told.notes);
    harmlessNotes = std::move(told.harmless);
  }
  useDiffuseAsBaseColor(document);
  checkGltfJson(document, name_, chunks.binary.has_value());
  dropDracoIndices(document);
  images_ = takeImages(document);
  const json buffers = takeBuffers(document);

  const std::string text = document.dump();
  if (text.size() > std::numeric_limits<uint32_t>::max()) refuse("has more than 4 GiB of JSON", "split the scene");
  tinygltf::TinyGLTF reader;
  std::string errors, warnings;
  if (!reader.LoadASCIIFromString(model_.get(), &errors, &warnings, text.data(), static_cast<uint32_t>(text.size()),
                                  ""))
    refuse("cannot be read as glTF: " + oneLine(errors), kRemedy);
  readBuffers(buffers, chunks.binary);
}

GltfDocument::~GltfDocument() = default;

void GltfDocument::readBuffers(const json& buffers, std::optional<std::string_view> binary) {
  uint64_t total = 0;
  budget_ = kBytesAlways;
  for (size_t i = 0; i < buffers.size(); ++i) {
    const std::string what = fmt::format("buffer {}", i), uri = buffers[i].value("uri", "");
    const uint64_t size = buffers[i]["byteLength"].get<uint64_t>();
    std::vector<unsigned char>& data = model_->buffers[i].data;
    data.clear();
    if (uri.empty() && !(binary && i == 0)) continue;  // a fallback: its views bring their own bytes
    const std::string owned = uri.empty() ? std::string() : bytesOfUri(uri, what, name_, folder_, options_);
    const std::string_view source = uri.empty() ? *binary : std::string_view(owned);
    if (source.size() < size)
      refuse(fmt::format("{} has {} bytes, but says {} (cut off?)", what, source.size(), size), kRemedy);
    total += size;
    if (total > kMostBufferBytes) refuse("its buffers have more than 8 GiB", "split the scene");
    data.assign(source.begin(), source.begin() + static_cast<std::ptrdiff_t>(size));
    budget_ += kBytesPerByte * size;
  }
}

std::span<const unsigned char> GltfDocument::viewBytes(int bufferView) {
  const tinygltf::BufferView& view = model_->bufferViews[bufferView];
  const auto bytesAt = [&](int buffer, size_t offset, size_t length) {
    const std::vector<unsigned char>& data = model_->buffers[buffer].data;
    if (offset > data.size() || length > data.size() - offset)
      refuse(fmt::format("bufferView {} ends beyond its buffer", bufferView), kRemedy);
    return std::span(data).subspan(offset, length);
  };
  const auto compressed = view.extensions.find("EXT_meshopt_compression");
  if (compressed == view.extensions.end()) return bytesAt(view.buffer, view.byteOffset, view.byteLength);
  const auto known = unpackedViews_.find(bufferView);
  if (known != unpackedViews_.end()) return known->second;

  const tinygltf::Value& value = compressed->second;
  const auto natural = [&](const char* property) {
    return value.Has(property) ? static_cast<size_t>(value.Get(property).GetNumberAsDouble()) : size_t{0};
  };
  const auto text = [&](const char* property) {
    return value.Has(property) ? value.Get(property).Get<std::string>() : std::string();
  };
  const MeshoptView packed{
      .mode = text("mode"), .filter = text("filter"), .count = natural("count"), .stride = natural("byteStride")};
  if (packed.stride > 256 || packed.count > view.byteLength || packed.count * packed.stride != view.byteLength)
    refuse(fmt::format("bufferView {}: {} compressed elements of {} bytes are not its {} bytes", bufferView,
                       packed.count, packed.stride, view.byteLength),
           kRemedy);
  spend(view.byteLength);
  try {
    return unpackedViews_
        .emplace(bufferView, unpackMeshopt(packed, bytesAt(static_cast<int>(natural("buffer")), natural("byteOffset"),
                                                           natural("byteLength"))))
        .first->second;
  } catch (const std::runtime_error& error) {
    refuse(fmt::format("bufferView {}: {}", bufferView, error.what()), kRemedy);
  }
}

std::string GltfDocument::imageBytes(int image) {
  const GltfImage& source = images_[image];
  if (source.bufferView >= 0) {
    const std::span<const unsigned char> bytes = viewBytes(source.bufferView);
    return {bytes.begin(), bytes.end()};
  }
  if (source.uri.empty()) refuse(fmt::format("image {} has neither a uri nor a bufferView", image), kRemedy);
  return bytesOfUri(source.uri, fmt::format("image {}", image), name_, folder_, options_);
}

void GltfDocument::refuse(const std::string& what, const std::string& remedy) const {
  throw fileError(name_, what, remedy);
}

void GltfDocument::spend(uint64_t bytes) {
  if (bytes > budget_) refuse("its primitives share accessors so often that they unfold beyond reason", kRemedy);
  budget_ -= bytes;
}

}  // namespace gnomon
