// roundTrip for every query, on the map at kBindMap.
#include "tests/kernel.glsl"
#include "tests/omni_functions.glsl"
RoundTrip evaluate(RoundTripQuery query) { return roundTrip(shadowMap, query); }
GNOMON_KERNEL(RoundTripQuery, RoundTrip, evaluate)
