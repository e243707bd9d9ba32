#include "shadow/filter.h"

#include "base/error.h"
#include "base/suggest.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

namespace gnomon {

const std::vector<Filter>& filters() {
  static const std::vector<Filter> all = {
      {.id = glsl::kShadowFilterNone, .name = "none", .tapCount = 1, .sentence = "the texel that contains the point"},
      {.id = glsl::kShadowFilterBilinear, .name = "bilinear", .tapCount = 4, .sentence = "2 x 2 PCF, bilinear weights"},
      {.id = glsl::kShadowFilterJitter4x4,
       .name = "jitter4x4",
       .tapCount = 16,
       .sentence = "PCF, 16 jittered taps within 4 x 4 texels (Weiskopf & Ertl 2003)",
       .knobs = {{.name = "width",
                  .unit = Unit::Texels,
                  .lower = 0.0f,
                  .upper = 64.0f,
                  .defaultValue = 4.0f,
                  .defaultOfSceneScale = false,
                  .sentence = "side of the square that the taps are spread over"}}},
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
      throw UsageError(fmt::format("--filters {}: no such filter; {}", word, chooseFrom(word, names)));
    if (std::ranges::find(chosen, &*found) == chosen.end()) chosen.push_back(&*found);
  }
  if (chosen.empty()) throw UsageError(fmt::format("--filters is empty; choose from {}", names));
  return chosen;
}

ChosenFilter::ChosenFilter(int wanted) : id(wanted) {
  const auto found = std::ranges::find(filters(), wanted, &Filter::id);
  if (found == filters().end()) return;
  tapCount = found->tapCount;
  for (size_t i = 0; i < found->knobs.size(); ++i) params.knobs[i] = found->knobs[i].defaultValue;
}

}  // namespace gnomon
