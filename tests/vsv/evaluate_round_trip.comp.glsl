// epipolarAnswer for every query, on the map at kBindMap.
#include "tests/kernel.glsl"
#include "tests/round_trip.glsl"
EpipolarAnswer evaluate(EpipolarQuery query) { return epipolarAnswer(shadowMap, query); }
GNOMON_KERNEL(EpipolarQuery, EpipolarAnswer, evaluate)
