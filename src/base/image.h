#pragma once
// Image files: EXR for data (32-bit float, linear), PNG for viewing (8 bits). PNG is written by image_png.h, all else
// goes through OpenImageIO. Rows run from top to bottom, channels are interleaved.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace gnomon {

template <typename T>
struct Image {
  int width = 0;     // pixels
  int height = 0;    // pixels
  int channels = 0;  // interleaved
  std::vector<T> values;

  Image() = default;
  Image(int w, int h, int c, T fill = T{})
      : width(w), height(h), channels(c), values(static_cast<size_t>(w) * h * c, fill) {}

  T* at(int x, int y) { return values.data() + (static_cast<size_t>(y) * width + x) * channels; }
  const T* at(int x, int y) const { return values.data() + (static_cast<size_t>(y) * width + x) * channels; }
};

using Image8 = Image<uint8_t>;
using ImageF = Image<float>;

// 1 (grey), 3 (RGB) or 4 (RGBA) channels, values as they are to be shown. Throws WorldError.
void writePng(const std::filesystem::path& path, const Image8& image);

// What an EXR's channels are: their names, such as {"Y"} or {"R","G","B"}, and what their numbers count.
struct ExrChannels {
  std::vector<std::string> names;
  std::string units;      // "cd/m^2", "metres"; its attribute gnomon:units
  bool isColour = false;  // linear, with the primaries of sRGB (ITU-R BT.709), which it says
};

// What all pictures of this run say of it: attributes Software and gnomon:command. No date: the same command gives the
// same bytes.
void setPictureOrigin(const std::string& software, const std::string& command);

// Any number of channels, 32-bit float. Throws WorldError.
void writeExr(const std::filesystem::path& path, const ImageF& image, const ExrChannels& channels);

// Any file OpenImageIO reads, as float (8-bit files give [0,1], not linearized). Throws WorldError.
ImageF readImage(const std::filesystem::path& path);

// Decodes an image held in memory (PNG, JPEG) to RGBA8; sRGB values stay sRGB. Throws WorldError that names `what`.
Image8 decodeImage(const uint8_t* bytes, size_t size, const std::string& what);

// A JPEG file in memory, of 1 or 3 channels; `quality` 1..100. Throws WorldError.
std::string encodeJpeg(const Image8& image, int quality);

// Begins on another thread to load what the functions above but writePng need (base/image_codec.h): for whom pictures
// are the last thing to come. Without it the first of them waits.
void preloadImages();

// RFC 4648, with padding: for data URIs.
std::string base64(std::string_view bytes);

// IEC 61966-2-1.
float srgbFromLinear(float linear);
float linearFromSrgb(float srgb);

// Linear RGB (3 channels) to sRGB bytes, clamped.
Image8 toSrgb8(const ImageF& linear);

}  // namespace gnomon
