#include "scene/gltf_document.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/parse_json.h"
#include "scene/gltf_check.h"

#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

namespace gnomon {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kRemedy = "export the file again, or check it with the Khronos glTF Validator";
constexpr uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;

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

// The JSON and the binary chunk in one .glb again, because tinygltf reads only that.
std::string joinGlb(std::string text, std::string_view binary) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const size_t padding = (4 - binary.size() % 4) % 4;
  const uint64_t size = 12 + 8 + text.size() + 8 + binary.size() + padding;
  std::string glb;
  glb.reserve(size);
  const auto addWord = [&](uint64_t word) {
    const uint32_t narrow = static_cast<uint32_t>(word);
    glb.append(reinterpret_cast<const char*>(&narrow), sizeof(narrow));
  };
  for (uint64_t word : {uint64_t{kGlbMagic}, uint64_t{2}, size, uint64_t{text.size()}, uint64_t{kJsonChunk}})
    addWord(word);
  glb += text;
  addWord(binary.size() + padding);
  addWord(kBinChunk);
  glb += binary;
  glb.append(padding, '\0');
  return glb;
}

// The files that a glTF names: regular ones beside or below or above it, each read once, so that neither a
// device nor a thousand buffers of one file can exhaust memory.
struct Neighbours {
  fs::path folder;  // empty: none
  std::set<fs::path> seen;
};

bool isReadable(const Neighbours& neighbours, const std::string& path) {
  std::error_code failure;
  return !neighbours.folder.empty() && fs::is_regular_file(path, failure);
}

tinygltf::FsCallbacks callbacksFor(Neighbours& neighbours) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.user_data = &neighbours;
  callbacks.FileExists = [](const std::string& path, void* user) {
    return isReadable(*static_cast<Neighbours*>(user), path);
  };
  callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* message, const std::string& path,
                               void* user) {
    Neighbours& self = *static_cast<Neighbours*>(user);
    std::error_code failure;
    if (!isReadable(self, path) || !self.seen.insert(fs::canonical(path, failure)).second) {
      *message = "two buffers name this file";
      return false;
    }
    const std::string bytes = readFile(path);
    out->assign(bytes.begin(), bytes.end());
    return true;
  };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  return callbacks;
}

bool isDataUri(const std::string& uri) {
  return uri.starts_with("data:");
}

// tinygltf takes a data: URI of a type that it does not know for the name of a file.
void checkBufferUris(const json& document, const std::string& name) {
  const auto buffers = document.find("buffers");
  if (buffers == document.end()) return;
  for (size_t i = 0; i < buffers->size(); ++i) {
    const std::string uri = (*buffers)[i].value("uri", "");
    if (isDataUri(uri) && !tinygltf::IsDataURI(uri))
      throw fileError(name, fmt::format("buffer {} has a data: uri of an unknown kind", i),
                      "use data:application/octet-stream;base64");
  }
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

std::string percentDecoded(const std::string& uri) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
  };
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool escaped = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    out += escaped ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
    if (escaped) i += 2;
  }
  return out;
}

}  // namespace

GltfDocument::GltfDocument(std::string_view bytes, std::string name, fs::path folder)
    : name_(std::move(name)), folder_(std::move(folder)), model_(std::make_unique<tinygltf::Model>()) {
  if (bytes.empty()) refuse("is empty", "name a .gltf or .glb file");
  const bool isBinary = bytes.size() >= 4 && wordAt(bytes, 0) == kGlbMagic;
  const Chunks chunks = isBinary ? splitGlb(bytes, name_) : Chunks{bytes, std::nullopt};
  json document = parseGltfJson(chunks.json, name_);
  checkGltfJson(document, name_, chunks.binary.has_value());
  checkBufferUris(document, name_);
  images_ = takeImages(document);

  std::string text = document.dump();
  if (chunks.binary) text = joinGlb(std::move(text), *chunks.binary);
  if (text.size() > std::numeric_limits<uint32_t>::max()) refuse("is larger than 4 GiB", "split the scene");
  Neighbours neighbours{folder_, {}};
  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks(callbacksFor(neighbours));
  std::string errors, warnings;
  const uint32_t size = static_cast<uint32_t>(text.size());
  // An absolute folder, so that a name is never looked for in the working folder.
  const std::string base = folder_.empty() ? "" : fs::absolute(folder_).string();
  const bool read = chunks.binary
                        ? reader.LoadBinaryFromMemory(model_.get(), &errors, &warnings,
                                                      reinterpret_cast<const unsigned char*>(text.data()), size, base)
                        : reader.LoadASCIIFromString(model_.get(), &errors, &warnings, text.data(), size, base);
  if (!read) refuse("cannot be read as glTF: " + oneLine(errors), kRemedy);

  budget_ = kBytesAlways;
  for (const tinygltf::Buffer& buffer : model_->buffers) budget_ += kBytesPerByte * buffer.data.size();
}

GltfDocument::~GltfDocument() = default;

std::string GltfDocument::imageBytes(int image) const {
  const GltfImage& source = images_[image];
  if (source.bufferView >= 0) {
    const tinygltf::BufferView& view = model_->bufferViews[source.bufferView];
    const std::vector<unsigned char>& data = model_->buffers[view.buffer].data;
    if (view.byteOffset + view.byteLength > data.size())
      refuse(fmt::format("image {} ends beyond its buffer", image), kRemedy);
    return {reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength};
  }
  if (source.uri.empty()) refuse(fmt::format("image {} has neither a uri nor a bufferView", image), kRemedy);
  if (isDataUri(source.uri)) {
    std::vector<unsigned char> out;
    std::string mimeType;
    if (!tinygltf::IsDataURI(source.uri) || !tinygltf::DecodeDataURI(&out, mimeType, source.uri, 0, false))
      refuse(fmt::format("image {} has a data: uri that cannot be decoded", image), kRemedy);
    return {out.begin(), out.end()};
  }
  const fs::path path = folder_ / percentDecoded(source.uri);
  if (!isReadable({folder_, {}}, path.string()))
    refuse(fmt::format("image {} is the file '{}', which is not there", image, oneLine(source.uri)),
           "put it beside the glTF file, or embed it");
  return readFile(path);
}

void GltfDocument::refuse(const std::string& what, const std::string& remedy) const {
  throw fileError(name_, what, remedy);
}

void GltfDocument::spend(uint64_t bytes) {
  if (bytes > budget_) refuse("its primitives share accessors so often that they unfold beyond reason", kRemedy);
  budget_ -= bytes;
}

}  // namespace gnomon
