// What filter_test.cpp evaluates on both sides.
#ifndef GNOMON_TEST_FILTER_FUNCTIONS_GLSL
#define GNOMON_TEST_FILTER_FUNCTIONS_GLSL

#include "shared/filter.glsl"

GNOMON_SHARED_BEGIN

struct FilterQuery {
  int kind;
  vec2 position;  // texels
  ivec2 pixel;
  int i;
};

struct FilterAnswer {
  ivec2 texel;
  float weight;
  vec2 kernel;
};

GNOMON_FN FilterAnswer answerFilter(FilterQuery query) {
  uint seed = pixelSeed(query.pixel);
  FilterTap tap = filterTap(query.kind, query.position, seed, query.i);
  FilterAnswer answer;
  answer.texel = tap.texel;
  answer.weight = tap.weight;
  answer.kernel = kernelOffset(query.kind, seed, query.i);
  return answer;
}

GNOMON_SHARED_END
#endif
