#include "base/image_png.h"

#include "base/error.h"
#include "base/message.h"

#include <png.h>

#include <csetjmp>
#include <cstring>
#include <vector>

namespace gnomon {

namespace {

// One for width and height alike, as glTF's loader has it.
constexpr png_uint_32 kMostSide = 16384;
// Of what a chunk of text or colours may unfold to: those are not needed.
constexpr png_alloc_size_t kMostChunkBytes = 8 << 20;

struct Source {
  const uint8_t* bytes = nullptr;
  size_t left = 0;
  char complaint[200] = {};
};

void readBytes(png_structp png, png_bytep out, png_size_t count) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (count > source->left) png_error(png, "it ends too soon");
  std::memcpy(out, source->bytes, count);
  source->bytes += count;
  source->left -= count;
}

// libpng's own would print.
[[noreturn]] void keepComplaint(png_structp png, png_const_charp text) {
  auto* source = static_cast<Source*>(png_get_error_ptr(png));
  std::strncpy(source->complaint, text, sizeof(source->complaint) - 1);
  png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

// Whatever a file has, as 8-bit RGBA.
void askForRgba8(png_structp png) {
  png_set_expand(png);  // palettes, fewer than 8 bits, the transparent colour
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
}

// No object with a destructor lives here: libpng leaves by longjmp, past them. Whether it came to the end.
bool readInto(png_structp png, png_infop info, Image8& image) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_user_limits(png, kMostSide, kMostSide);
  png_set_chunk_malloc_max(png, kMostChunkBytes);
  png_read_info(png, info);
  askForRgba8(png);
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, info);
  image.width = static_cast<int>(png_get_image_width(png, info));
  image.height = static_cast<int>(png_get_image_height(png, info));
  image.channels = 4;
  const size_t lineBytes = png_get_rowbytes(png, info);
  if (lineBytes != 4 * static_cast<size_t>(image.width)) png_error(png, "its lines have another length");
  image.values.resize(lineBytes * static_cast<size_t>(image.height));
  for (int pass = 0; pass < passes; ++pass)
    for (int y = 0; y < image.height; ++y) png_read_row(png, image.at(0, y), nullptr);
  png_read_end(png, nullptr);
  return true;
}

}  // namespace

Image8 decodePng(const uint8_t* bytes, size_t size, const std::string& what) {
  Source source{.bytes = bytes, .left = size};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, keepComplaint, ignoreWarning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr) {
    png_destroy_read_struct(&png, nullptr, nullptr);
    throw std::bad_alloc();
  }
  png_set_read_fn(png, &source, readBytes);
  Image8 image;
  bool whole = false;
  try {
    whole = readInto(png, info, image);
  } catch (...) {  // memory for the image
    png_destroy_read_struct(&png, &info, nullptr);
    throw;
  }
  png_destroy_read_struct(&png, &info, nullptr);
  if (!whole) throw fileError(what, "cannot be decoded as PNG", oneLine(source.complaint, 120));
  return image;
}

}  // namespace gnomon
