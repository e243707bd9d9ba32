// What filter_test.cpp evaluates on both sides.
#ifndef GNOMON_TEST_FILTER_FUNCTIONS_GLSL
#define GNOMON_TEST_FILTER_FUNCTIONS_GLSL

#include "shared/filter.glsl"

GNOMON_SHARED_BEGIN

struct FilterQuery {
  int kind;
  FilterParams params;
  vec2 position;  // texels
  ivec2 pixel;
  int i;
};

struct FilterAnswer {
  ivec2 texel;
  float weight;
  vec2 kernel;
  int known;  // 1: its taps, 2: its kernel
};

GNOMON_FN FilterAnswer answerFilter(FilterQuery query) {
  uint seed = pixelSeed(query.pixel);
  bool tapKnown;
  bool kernelKnown;
  FilterTap tap = filterTap(query.kind, query.params, query.position, seed, query.i, tapKnown);
  FilterAnswer answer;
  answer.texel = tap.texel;
  answer.weight = tap.weight;
  answer.kernel = kernelOffset(query.kind, query.params, seed, query.i, kernelKnown);
  answer.known = (tapKnown ? 1 : 0) + (kernelKnown ? 2 : 0);
  return answer;
}

GNOMON_SHARED_END
#endif
