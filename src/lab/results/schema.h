#pragma once
// The schema of results.json (docs/results.md), and what its parts share.

#include <string>
#include <utility>
#include <vector>

namespace gnomon {

inline constexpr int kResultsVersion = 4;

const char* gnomonVersion();

// Digits of a float: 0.1f as 0.1, not as 0.10000000149.
double shortest(float value);

// Names and paths below the folder of results.json, in the order they are shown.
using Pictures = std::vector<std::pair<std::string, std::string>>;

// The square of the picture with the most pixels of one label.
struct WorstPlace {
  int x = 0, y = 0;  // its upper left corner
  int size = 0;
  size_t pixels = 0;
};
inline constexpr int kWorstSide = 64;  // pixels

}  // namespace gnomon
