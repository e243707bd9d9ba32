// What planar_map_test.cpp and bias_on_the_gpu_test.cpp evaluate on both sides. The map itself is the buffer that
// shared/map.glsl declares; in C++ it is the argument.
#ifndef GNOMON_TEST_MAP_FUNCTIONS_GLSL
#define GNOMON_TEST_MAP_FUNCTIONS_GLSL

#include "shared/bias.glsl"

GNOMON_SHARED_BEGIN

struct MapQuery {
  vec3 posL;
  vec2 uv;
  float depth;
};

struct MapAnswer {
  vec2 uv;
  int slice;
  int covered;
  vec3 origin;
  vec3 dir;
  float depth;
  float slope;
  float distance;
};

GNOMON_FN MapAnswer answerMap(ShadowMap map, MapQuery query) {
  MapPoint point = mapProject(map, query.posL);
  Ray ray = mapTexelRay(map, 0, query.uv);
  MapAnswer answer;
  answer.uv = point.uv;
  answer.slice = point.slice;
  answer.covered = point.covered ? 1 : 0;
  answer.origin = ray.origin;
  answer.dir = ray.dir;
  answer.depth = mapDepth(map, 0, query.posL);
  answer.slope = mapDepthSlope(map, 0, query.posL, ray.dir);
  answer.distance = mapDistance(map, 0, ray, query.depth);
  return answer;
}

struct BiasQuery {
  int method;
  BiasParams params;
  Receiver receiver;
  float z1;
  float z2;
  float zBack;
};

const int kNoSuchBias = 999;
const uint kAnswerShadow = 0u;
const uint kAnswerLight = 1u;
const uint kAnswerUnknown = 2u;  // no such method

GNOMON_FN uint answerBias(ShadowMap map, BiasQuery query) {
  Receiver receiver = biasReceiver(query.method, map, query.params, query.receiver);
  MapPoint point = mapProject(map, receiver.posL);
  ivec2 texel = mapTexel(map, point.uv);
  Tap tap = emptyTap(point.slice, texel, mapTexelRay(map, point.slice, mapTexelCenter(map, texel)));
  tap.z1 = query.z1;
  tap.z2 = query.z2;
  tap.zBack = query.zBack;
  bool known;
  bool lit = biasLit(query.method, map, query.params, receiver, tap, known);
  return known ? (lit ? kAnswerLight : kAnswerShadow) : kAnswerUnknown;
}

GNOMON_SHARED_END
#endif
