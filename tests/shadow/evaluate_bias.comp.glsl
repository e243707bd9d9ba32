// answerBias for every query, on the map at kBindMap.
#include "tests/kernel.glsl"
#include "tests/map_functions.glsl"
uint evaluate(BiasQuery query) { return answerBias(shadowMap, query); }
GNOMON_KERNEL(BiasQuery, uint, evaluate)
