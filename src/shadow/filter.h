#pragma once
// The list of filters: name, taps, parameters and a sentence. Flags, --help and reports derive from it; the taps and
// kernels are in shaders/shared/filter.glsl.

#include "shadow/knob.h"

#include "shared/filter.glsl"

#include <string>
#include <vector>

namespace gnomon {

struct Filter {
  int id;  // kShadowFilter*
  const char* name;
  int tapCount;
  const char* sentence;
  std::vector<Knob> knobs = {};  // at most kMostFilterKnobs; in the order of their places in FilterParams::knobs
};

const std::vector<Filter>& filters();

// "a,b" or "all", each once. Throws UsageError that lists the names.
std::vector<const Filter*> parseFilters(const std::string& list);

// A filter with its knobs set.
struct ChosenFilter {
  int id = glsl::kShadowFilterNone;
  int tapCount = 1;
  glsl::FilterParams params{};
  // At its defaults. An id that is none of the list's is drawn in magenta.
  ChosenFilter(int id);  // NOLINT(google-explicit-constructor): an id says it all
};

}  // namespace gnomon
