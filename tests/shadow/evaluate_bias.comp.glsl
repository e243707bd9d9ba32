// answerBias for every query, on the map at kBindMap; of one kind of map, as the visibility pass is compiled.
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_MAP_KIND kMapKind
#include "tests/kernel.glsl"
#include "tests/map_functions.glsl"
uint evaluate(BiasQuery query) { return answerBias(shadowMap, query); }
GNOMON_KERNEL(BiasQuery, uint, evaluate)
