#pragma once
// The part of image.h that calls OpenImageIO, in a separate library that is loaded when the first image is read, or
// written as anything but PNG (image_png.h): Debian's OpenImageIO depends on 250 others, and loading them takes as long
// as rendering a small picture (0.2 s). For image.cpp only.

#include "base/image.h"

namespace gnomon {

// As setPictureOrigin has it.
struct ExrOrigin {
  std::string software, command;
};

// As the functions of these names in image.h; encodeExr makes the bytes that writeExr writes.
struct ImageCodec {
  std::string (*encodeExr)(const ImageF& image, const ExrChannels& channels, const ExrOrigin& origin);
  ImageF (*readImage)(const std::filesystem::path& path);
  Image8 (*decodeImage)(const uint8_t* bytes, size_t size, const std::string& what);
  std::string (*encodeJpeg)(const Image8& image, int quality);
  std::string (*base64)(std::string_view bytes);
};

// The library's one symbol; `extern "C"`, so that its name is what is written here.
inline constexpr const char* kImageCodecLibrary = "libgnomon_images.so";
inline constexpr const char* kImageCodecSymbol = "gnomonImageCodec";

// Loaded once. Throws WorldError where the library is not to be found.
const ImageCodec& imageCodec();

}  // namespace gnomon
