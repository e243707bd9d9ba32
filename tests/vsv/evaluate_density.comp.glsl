// densityAtIndex for every point of index space; the grid is the buffer at kBindDensity.
#include "tests/kernel.glsl"
#include "vsv/density_fetch.glsl"
struct DensityQuery {
  vec3 posI;
};
float evaluate(DensityQuery query) { return densityAtIndex(query.posI); }
GNOMON_KERNEL(DensityQuery, float, evaluate)
