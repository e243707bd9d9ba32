#pragma once
// The list of filters; their taps and kernels are in shaders/shared/filter.glsl.

#include "shared/filter.glsl"

#include <string>
#include <vector>

namespace gnomon {

struct Filter {
  int id;  // kFilter*
  const char* name;
  const char* sentence;
};

const std::vector<Filter>& filters();

// "a,b" or "all", each once. Throws UsageError that lists the names.
std::vector<const Filter*> parseFilters(const std::string& list);

}  // namespace gnomon
