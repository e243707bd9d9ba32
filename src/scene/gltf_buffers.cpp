#include "scene/gltf_buffers.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "scene/gltf_document.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <tiny_gltf.h>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

std::string lowered(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

bool isDataUri(std::string_view uri) {
  return lowered(uri.substr(0, 5)) == "data:";
}

// data:[type][;parameter...][;base64],bytes (RFC 2397)
std::string bytesOfDataUri(const std::string& uri, const std::string& what, const std::string& fileName) {
  const size_t comma = uri.find(',');
  const auto refuse = [&] {
    return fileError(fileName, what + " has a data: uri that cannot be decoded",
                     "use data:application/octet-stream;base64");
  };
  if (comma == std::string::npos) throw refuse();
  if (!lowered(std::string_view(uri).substr(0, comma)).ends_with(";base64"))
    return percentDecoded(uri.substr(comma + 1));
  std::vector<unsigned char> bytes;
  std::string type;
  if (!tinygltf::DecodeDataURI(&bytes, type, "data:application/octet-stream;base64," + uri.substr(comma + 1), 0, false))
    throw refuse();
  return {bytes.begin(), bytes.end()};
}

bool isWithin(const fs::path& path, const fs::path& folder) {
  std::error_code failure;
  const fs::path whole = fs::canonical(folder, failure);
  if (failure) return false;
  const auto end = std::ranges::mismatch(whole, path);
  return end.in1 == whole.end();
}

}  // namespace

std::string percentDecoded(std::string_view text) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
  };
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool escaped = text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
    out += escaped ? static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2])) : text[i];
    if (escaped) i += 2;
  }
  return out;
}

std::string bytesOfUri(const std::string& uri, const std::string& what, const std::string& fileName,
                       const fs::path& folder, const GltfOptions& options) {
  if (isDataUri(uri)) return bytesOfDataUri(uri, what, fileName);
  const std::string shown = oneLine(uri);
  const fs::path relative = percentDecoded(uri);
  std::error_code failure;
  const fs::path path = folder.empty() ? fs::path() : fs::canonical(folder / relative, failure);
  if (folder.empty() || failure || !fs::exists(path, failure))
    throw fileError(fileName, fmt::format("{} is the file '{}', which is not there", what, shown),
                    "put it beside the glTF file, or embed it");
  const bool allowed =
      (relative.is_relative() && isWithin(path, folder)) ||
      std::ranges::any_of(options.allowedFolders, [&](const fs::path& f) { return isWithin(path, f); });
  if (!allowed)
    throw fileError(fileName, fmt::format("{} is the file '{}', outside the scene's own folder", what, shown),
                    "put it beside the glTF file, or name its folder with --allow-path");
  if (!fs::is_regular_file(path, failure))
    throw fileError(fileName, fmt::format("{} is '{}', which is no regular file", what, shown), "name a file");
  return readFile(path);
}

std::vector<unsigned char> unpackMeshopt(const MeshoptView& view, std::span<const unsigned char> packed) {
  std::vector<unsigned char> out(view.count * view.stride);
  const size_t count = view.count, stride = view.stride;
  const auto check = [](bool ok, const char* what) {
    if (!ok) throw std::runtime_error(what);
  };
  if (view.mode == "ATTRIBUTES") {
    check(stride % 4 == 0 && stride >= 4 && stride <= 256, "its stride is not a multiple of 4 up to 256");
    check(meshopt_decodeVertexBuffer(out.data(), count, stride, packed.data(), packed.size()) == 0,
          "its compressed bytes are damaged");
    if (view.filter == "OCTAHEDRAL") {
      check(stride == 4 || stride == 8, "OCTAHEDRAL needs a stride of 4 or 8");
      meshopt_decodeFilterOct(out.data(), count, stride);
    } else if (view.filter == "QUATERNION") {
      check(stride == 8, "QUATERNION needs a stride of 8");
      meshopt_decodeFilterQuat(out.data(), count, stride);
    } else if (view.filter == "EXPONENTIAL") {
      meshopt_decodeFilterExp(out.data(), count, stride);
    } else {
      check(view.filter.empty() || view.filter == "NONE", "its filter is unknown");
    }
    return out;
  }
  check(stride == 2 || stride == 4, "indices need a stride of 2 or 4");
  if (view.mode == "TRIANGLES") {
    check(count % 3 == 0, "its triangles have no multiple of 3 indices");
    check(meshopt_decodeIndexBuffer(out.data(), count, stride, packed.data(), packed.size()) == 0,
          "its compressed bytes are damaged");
  } else {
    check(view.mode == "INDICES", "its mode is unknown");
    check(meshopt_decodeIndexSequence(out.data(), count, stride, packed.data(), packed.size()) == 0,
          "its compressed bytes are damaged");
  }
  return out;
}

}  // namespace gnomon
