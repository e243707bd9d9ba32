#include "base/image.h"

#include "base/error.h"
#include "base/file.h"
#include "base/image_codec.h"
#include "base/image_png.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace gnomon {

void writePng(const std::filesystem::path& path, const Image8& image) {
  writeTextFile(path, encodePng(image));
}

namespace {

ExrOrigin pictureOrigin{.software = "gnomon", .command = ""};

}  // namespace

void setPictureOrigin(const std::string& software, const std::string& command) {
  pictureOrigin = {.software = software, .command = command};
}

void writeExr(const std::filesystem::path& path, const ImageF& image, const ExrChannels& channels) {
  writeTextFile(path, imageCodec().encodeExr(image, channels, pictureOrigin));
}

ImageF readImage(const std::filesystem::path& path) {
  return imageCodec().readImage(path);
}

Image8 decodeImage(const uint8_t* bytes, size_t size, const std::string& what) {
  // The first byte of a PNG, and of no JPEG.
  if (size > 0 && bytes[0] == 0x89) return decodePng(bytes, size, what);
  return imageCodec().decodeImage(bytes, size, what);
}

std::string encodeJpeg(const Image8& image, int quality) {
  return imageCodec().encodeJpeg(image, quality);
}

void preloadImages() {
  // Joined when the program ends.
  static const std::jthread loader([] {
    try {
      imageCodec();
    } catch (const WorldError&) {
      // Who needs it asks again, and is told.
    }
  });
}

std::string base64(std::string_view bytes) {
  return imageCodec().base64(bytes);
}

float srgbFromLinear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

float linearFromSrgb(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Image8 toSrgb8(const ImageF& linear) {
  Image8 out(linear.width, linear.height, linear.channels);
  tbb::parallel_for(size_t{0}, out.values.size(), [&](size_t i) {
    const float value = srgbFromLinear(std::clamp(linear.values[i], 0.0f, 1.0f));
    out.values[i] = static_cast<uint8_t>(std::lround(255.0f * value));
  });
  return out;
}

}  // namespace gnomon
