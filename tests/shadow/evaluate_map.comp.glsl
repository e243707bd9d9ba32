// answerMap for every query, on the map at kBindMap.
#include "tests/kernel.glsl"
#include "tests/map_functions.glsl"
MapAnswer evaluate(MapQuery query) { return answerMap(shadowMap, query); }
GNOMON_KERNEL(MapQuery, MapAnswer, evaluate)
