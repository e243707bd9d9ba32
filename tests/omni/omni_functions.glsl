// What the tests of omni/ evaluate on both sides. The map itself is the buffer that shared/map.glsl declares; in C++ it
// is the argument.
#ifndef GNOMON_TEST_OMNI_FUNCTIONS_GLSL
#define GNOMON_TEST_OMNI_FUNCTIONS_GLSL

#include "shared/map.glsl"

GNOMON_SHARED_BEGIN

struct RoundTripQuery {
  vec3 posL;
  float depth;
};

struct RoundTrip {
  int slice;
  int covered;
  vec2 uv;
  vec3 origin;
  vec3 dir;
  float depth;
  float slope;
  float distance;
  // Where the ray through uv, at the point's distance, comes out again.
  int sliceAgain;
  vec2 uvAgain;
};

GNOMON_FN RoundTrip roundTrip(ShadowMap map, RoundTripQuery query) {
  MapPoint point = mapProject(map, query.posL);
  Ray ray = mapTexelRay(map, point.slice, point.uv);
  RoundTrip answer;
  answer.slice = point.slice;
  answer.covered = point.covered ? 1 : 0;
  answer.uv = point.uv;
  answer.origin = ray.origin;
  answer.dir = ray.dir;
  answer.depth = mapDepth(map, point.slice, query.posL);
  answer.slope = mapDepthSlope(map, point.slice, query.posL, ray.dir);
  answer.distance = mapDistance(map, point.slice, ray, query.depth);
  MapPoint again = mapProject(map, ray.origin + ray.dir * length(query.posL));
  answer.sliceAgain = again.slice;
  answer.uvAgain = again.uv;
  return answer;
}

GNOMON_SHARED_END
#endif
