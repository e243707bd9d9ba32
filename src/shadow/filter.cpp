#include "shadow/filter.h"

#include "base/error.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

namespace gnomon {

const std::vector<Filter>& filters() {
  static const std::vector<Filter> all = {
      {.id = glsl::kFilterNone, .name = "none", .sentence = "the one texel that holds the point"},
      {.id = glsl::kFilterBilinear, .name = "bilinear", .sentence = "the 2 x 2 texels around it, weighted by distance"},
      {.id = glsl::kFilterJitter4x4,
       .name = "jitter4x4",
       .sentence = "16 jittered taps within 4 x 4 texels (Weiskopf & Ertl 2003)"},
  };
  return all;
}

std::vector<const Filter*> parseFilters(const std::string& list) {
  std::vector<const Filter*> chosen;
  std::string names;
  for (const Filter& filter : filters()) {
    names += (names.empty() ? "" : ", ") + std::string(filter.name);
    if (list == "all") chosen.push_back(&filter);
  }
  if (list == "all") return chosen;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    const auto found = std::ranges::find_if(filters(), [&](const Filter& f) { return f.name == word; });
    if (found == filters().end())
      throw UsageError(fmt::format("--filters {}: no such filter; choose from {}", word, names));
    if (std::ranges::find(chosen, &*found) == chosen.end()) chosen.push_back(&*found);
  }
  if (chosen.empty()) throw UsageError(fmt::format("--filters is empty; choose from {}", names));
  return chosen;
}

}  // namespace gnomon
