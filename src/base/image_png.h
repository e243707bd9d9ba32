#pragma once
// PNG files in memory, by zlib and all cores: ISO/IEC 15948 (https://www.w3.org/TR/png-3/), 8 bits a channel. Lines are
// cut in bands that are packed at the same time, as pigz does it (Adler): one deflate stream of several stretches. The
// same image gives the same bytes, however many threads there are.

#include "base/image.h"

namespace gnomon {

// 1 (grey), 3 (RGB) or 4 (RGBA) channels.
std::string encodePng(const Image8& image);

// As decodeImage, by libpng: line by line, so that it takes no more than the image; and what libpng has to say is the
// error's, and not printed.
Image8 decodePng(const uint8_t* bytes, size_t size, const std::string& what);

}  // namespace gnomon
