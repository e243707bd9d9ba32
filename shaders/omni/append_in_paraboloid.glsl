// A bound on a paraboloid's plane, where y points up, as a triangle to draw.
#ifndef GNOMON_APPEND_IN_PARABOLOID_GLSL
#define GNOMON_APPEND_IN_PARABOLOID_GLSL

#include "shared/paraboloid_bound.glsl"

#include "shadow/append_bounded.glsl"

void append(QuadBound bound, LightTriangle triangle, vec3 inverseNormal, uint index, uint instance, uint id) {
  BoundedTriangle result;
  result.corners[0] = vec2(bound.p0.x, -bound.p0.y);
  result.corners[1] = vec2(bound.p1.x, -bound.p1.y);
  result.corners[2] = vec2(bound.p2.x, -bound.p2.y);
  result.corners[3] = vec2(bound.p3.x, -bound.p3.y);
  result.sideA = triangle.sideA;
  result.sideB = triangle.sideB;
  result.sideC = triangle.sideC;
  result.inverseNormal = inverseNormal;
  result.triangle = index;
  result.instance = instance;
  result.id = id;
  append(result);
}

#endif
