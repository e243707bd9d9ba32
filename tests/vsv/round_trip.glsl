// What the tests of the epipolar map evaluate on both sides. The map itself is the buffer that shared/map.glsl
// declares; in C++ it is the argument.
#ifndef GNOMON_TEST_ROUND_TRIP_GLSL
#define GNOMON_TEST_ROUND_TRIP_GLSL

#include "shared/map.glsl"
#include "shared/volume_lookup.glsl"

GNOMON_SHARED_BEGIN

struct EpipolarQuery {
  vec3 posL;
  vec3 normalL;
};

struct EpipolarAnswer {
  int covered;
  vec2 uv;
  float depth;
  float slope;
  float distance;  // of that depth along the ray through uv
  vec3 dir;
  vec2 uvAgain;    // of the point at that distance
  int voxelNone, voxelConstant, voxelAdaptive;  // that decide
};

GNOMON_FN EpipolarAnswer epipolarAnswer(ShadowMap map, EpipolarQuery query) {
  EpipolarAnswer answer;
  MapPoint point = mapProject(map, query.posL);
  Ray ray = mapTexelRay(map, 0, point.uv);
  answer.covered = point.covered ? 1 : 0;
  answer.uv = point.uv;
  answer.dir = ray.dir;
  answer.depth = mapDepth(map, 0, query.posL);
  answer.slope = mapDepthSlope(map, 0, query.posL, ray.dir);
  answer.distance = mapDistance(map, 0, ray, answer.depth);
  answer.uvAgain = mapProject(map, ray.origin + ray.dir * answer.distance).uv;
  Receiver receiver;
  receiver.posL = query.posL;
  receiver.normalL = query.normalL;
  BiasParams params;
  params.epsilonAt = kEpsilonAtOccluder;
  Ray column = mapTexelRay(map, 0, mapTexelCenter(map, mapTexel(map, point.uv)));
  bool known;
  answer.voxelNone = decidingVoxel(kBiasNone, map, params, receiver, column, known);
  params.knobs[kConstantOffset] = 0.05f;
  answer.voxelConstant = decidingVoxel(kBiasConstant, map, params, receiver, column, known);
  params.knobs[kAdaptiveK] = 1e-4f;
  answer.voxelAdaptive = decidingVoxel(kBiasAdaptive, map, params, receiver, column, known);
  return answer;
}

GNOMON_SHARED_END
#endif
