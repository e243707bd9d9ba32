#pragma once
// Where in a JSON text its values stand.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gnomon {

struct JsonPlaces {
  // "maps[1].options.warp" to the offset where the value begins; the whole is "". In the order of the text.
  std::vector<std::pair<std::string, size_t>> offsets;
  // Of the first member that an object has twice; empty where none has.
  std::string twice;
};

// Of a text that a parser has accepted, comments and all, and which is nested no more than a few dozen deep.
JsonPlaces placesInJson(std::string_view text);

struct LineAndColumn {
  size_t line = 1, column = 1;  // of characters (UTF-8), as editors count
};
LineAndColumn lineAndColumn(std::string_view text, size_t offset);

}  // namespace gnomon
