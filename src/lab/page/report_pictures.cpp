#include "lab/page/report_pictures.h"

#include "base/error.h"
#include "base/file.h"
#include "base/image.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

// Shaded pictures have no edge sharper than a texel's; at 88 no block shows at the crops' zoom.
constexpr int kJpegQuality = 88;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

bool staysWithin(const fs::path& path) {
  if (path.empty() || path.is_absolute()) return false;
  return *path.lexically_normal().begin() != "..";
}

// Big-endian, as in the PNG's header chunk: W3C PNG, 11.2.2.
int pngNumber(const std::string& png, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(png[at + i]);
  return static_cast<int>(std::min(value, 1u << 24));
}

std::string jpegOf(const std::string& png, const std::string& path) {
  const Image8 rgba = decodeImage(reinterpret_cast<const uint8_t*>(png.data()), png.size(), path);
  Image8 rgb(rgba.width, rgba.height, 3);
  for (size_t i = 0; i < rgb.values.size() / 3; ++i) std::copy_n(&rgba.values[4 * i], 3, &rgb.values[3 * i]);
  return encodeJpeg(rgb, kJpegQuality);
}

}  // namespace

std::optional<EmbeddedPicture> ReportPictureShelf::embed(const std::string& path, bool asJpeg) {
  if (const auto found = embedded_.find(path); found != embedded_.end()) return found->second;
  try {
    if (!staysWithin(path)) throw fileError(path, "leaves the folder", "");
    const std::string png = readRegularFile(folder_ / path);
    if (!png.starts_with(kPngSignature) || png.size() < 24) throw fileError(path, "is not a PNG", "");
    EmbeddedPicture picture{.id = fmt::format("picture-{}", embedded_.size() + 1),
                            .dataUri = asJpeg ? "data:image/jpeg;base64," + base64(jpegOf(png, path))
                                              : "data:image/png;base64," + base64(png),
                            .width = pngNumber(png, 16),
                            .height = pngNumber(png, 20)};
    EmbeddedPicture& kept = embedded_[path] = picture;
    kept.dataUri.clear();
    return picture;
  } catch (const WorldError&) {
    if (std::ranges::find(missing_, path) == missing_.end()) missing_.push_back(path);
    return std::nullopt;
  }
}

}  // namespace gnomon
