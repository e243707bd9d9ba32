#pragma once
// `gnomon compare --until-error`: of each method the smallest map at which few enough of all pixels are wrong, and what
// that costs.

#include "lab/results/schema.h"

#include <optional>
#include <vector>

namespace gnomon {

// One method on a map of one size.
struct SizedError {
  int mapSide = 0;
  size_t mapTexels = 0, mapBytes = 0;
  double allWrong = 0.0;
  double buildMs = 0.0, shadeMs = 0.0, frameMs = 0.0;

  static constexpr auto fields() {
    return std::tuple(
        field("map_size", &SizedError::mapSide, {.unit = "texels", .says = "width of a slice", .least = 1.0}),
        field("map_texels", &SizedError::mapTexels, {.says = "in all slices"}),
        field("map_bytes", &SizedError::mapBytes, {.unit = "bytes", .says = "of the channels that its bias reads"}),
        field("all_wrong", &SizedError::allWrong, {.says = "wrong pixels / scored", .least = 0.0, .most = 1.0}),
        field("build_ms", &SizedError::buildMs, {.unit = "ms", .says = "as of a row", .least = 0.0}),
        field("shade_ms", &SizedError::shadeMs, {.unit = "ms", .says = "as of a row", .least = 0.0}),
        field("frame_ms", &SizedError::frameMs, {.unit = "ms", .says = "as of a row", .least = 0.0}));
  }
};

struct EqualErrorMethod {
  std::string map, light, bias;
  std::optional<SizedError> smallest;
  std::vector<SizedError> sizes;

  static constexpr auto fields() {
    return std::tuple(
        field("map", &EqualErrorMethod::map, {.says = "parameterization"}),
        field("light", &EqualErrorMethod::light, {.says = "name of the light"}),
        field("bias", &EqualErrorMethod::bias, {.says = "its name; its parameters are those of its rows"}),
        field("smallest", &EqualErrorMethod::smallest,
              {.says = "the smallest map that is good enough; null where none was; below"}),
        field("sizes", &EqualErrorMethod::sizes, {.says = "all sizes that were tried, smallest first; as `smallest`"}));
  }
};

struct EqualError {
  double limit = 0.0;
  int largestSide = 0;
  std::vector<EqualErrorMethod> methods;

  static constexpr auto fields() {
    return std::tuple(field("limit", &EqualError::limit, {.says = "wrong pixels / scored that are good enough"}),
                      field("largest_map_size", &EqualError::largestSide,
                            {.unit = "texels", .says = "width of a slice of the largest map that may be tried"}),
                      field("methods", &EqualError::methods,
                            {.says = "the least frame time first, then those that no map sufficed for; below"}));
  }
};

}  // namespace gnomon
