#pragma once
// The schema version of results.json (docs/results.md), and helpers that its parts share.

#include "lab/results/field.h"

#include <string>
#include <utility>
#include <vector>

namespace gnomon {

inline constexpr int kResultsVersion = 4;

const char* gnomonVersion();

// Digits of a float: 0.1f as 0.1, not as 0.10000000149.
double shortest(float value);

// An object of texts, in the order of the file.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;

// Names and paths below the folder of results.json, in the order they are shown.
using Pictures = NamedTexts;

// Of files: "1b2c3d4e spot/none.labels.png", the CRC-32 of each and its path.
using FileSums = std::vector<std::string>;

// A picture's side is at most this, pixels.
inline constexpr int kMaxPictureSide = 16384;

// The square of the picture with the most pixels of one label.
struct WorstPlace {
  int x = 0, y = 0, size = 0;
  std::optional<size_t> pixels;

  static constexpr auto fields() {
    return std::tuple(
        field("x", &WorstPlace::x, {.unit = "pixels", .says = "left edge", .most = kMaxPictureSide}),
        field("y", &WorstPlace::y, {.unit = "pixels", .says = "top edge", .most = kMaxPictureSide}),
        field("size", &WorstPlace::size,
              {.unit = "pixels", .says = "width and height", .least = 1, .most = kMaxPictureSide}),
        field("pixels", &WorstPlace::pixels,
              {.says = "number of pixels with the label in it; only in rows", .absent = Absent::LeftOut}));
  }
};
inline constexpr int kWorstSide = 64;  // pixels

}  // namespace gnomon
