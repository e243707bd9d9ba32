// Two planes: a receiver is in shadow only where both the receiver's plane and the caster's say so.
//
// adaptive's test (Dou et al. 2014) extends the receiver's plane to the texel's ray: wrong in a valley, where the plane
// passes below the surface that the texel sees. Its mirror extends the caster's plane to the receiver's ray: wrong on a
// ridge. On a crease of two planes one of the two is always right, and light is what it says:
//
//     lit  <=>  the texel's point lies not before the receiver's plane,  or  P lies not behind the caster's plane
//
//   two-plane        the caster is the triangle that the texel names
//   two-plane-depth  the caster's plane is one of four through the texel's depth and two of its neighbours', one beside
//                    and one above or below; light where P lies before any
#ifndef GNOMON_BIAS_TWO_PLANE_GLSL
#define GNOMON_BIAS_TWO_PLANE_GLSL

#include "shared/lang.glsl"
#include "shared/sheet_walk.glsl"

GNOMON_SHARED_BEGIN

// A point of the texel's ray, as lightSide() takes it.
GNOMON_FN vec3 alongRay(LookupTables tables, Ray ray) { return tables.positional == 1.0f ? ray.dir : ray.origin; }

GNOMON_FN bool twoPlaneLit(LookupTables tables, Receiver receiver, PlacedTriangle caster, Ray ray) {
  SheetTriangle triangle = sheetTriangle(tables, caster);
  float area = lightSide(tables, triangle.a, triangle.b, triangle.c);
  if (area == 0.0f) return true;
  vec3 q = clampedToTriangle(tables, triangle, alongRay(tables, ray), area < 0.0f ? -1.0f : 1.0f);
  return twoPlanesLight(tables, triangle, q, receiver.posL, receiver.normalL);
}

// The texel beside another, in whatever slice; held where there is one and something is drawn in it.
struct DepthPoint {
  vec3 posL;
  float depth;
  bool held;
};

GNOMON_FN DepthPoint depthPointAt(ShadowMap map, LookupTables tables, int slice, ivec2 texel, vec3 posL) {
  MapTexel found = mapTexelAcross(map, slice, texel, posL);
  DepthPoint point;
  point.held = found.held;
  point.depth = 1.0f;
  point.posL = posL;
  if (found.held) {
    point.depth = mapDepthAt(tables, found.slice, found.texel);
    point.held = point.depth < 1.0f;
    Ray ray = mapTexelRay(map, found.slice, mapTexelCenter(map, found.texel));
    point.posL = ray.origin + ray.dir * mapDistance(map, found.slice, ray, point.depth);
  }
  return point;
}

// Whether p lies behind the plane through three depths, by more than `error`, metres along the ray.
GNOMON_FN bool isBehindDepths(DepthPoint center, DepthPoint beside, DepthPoint above, vec3 dir, vec3 p,
                              float error) {
  if (!beside.held || !above.held) return true;
  vec3 normal = cross(beside.posL - center.posL, above.posL - center.posL);
  float facing = dot(normal, dir);
  if (facing == 0.0f) return true;
  return dot(normal, p - center.posL) / facing > error;
}

// How far off a stored depth may be: a few 2^-24 of the range, and the rasterizer's plane equation, whose products are
// as large as the plane's change across the whole slice (tests/omni/rendered_slices_test.cpp measures it). The plane at
// P is a mean of three depths, with weights of at most 1, 1/2 and 1/2 in size: twice one depth's error.
GNOMON_FN float depthRounding(ShadowMap map, float z, float beside, float above) {
  float change = abs(beside - z) + abs(above - z);
  return 2.0f * 5.9604645e-8f * (16.0f + 4.0f * change * float(max(map.width, map.height)));
}

GNOMON_FN bool twoPlaneDepthLit(ShadowMap map, LookupTables tables, Receiver receiver, Tap tap) {
  DepthPoint center;
  center.held = true;
  center.depth = tap.z1;
  center.posL = tap.ray.origin + tap.ray.dir * mapDistance(map, tap.slice, tap.ray, tap.z1);
  DepthPoint left = depthPointAt(map, tables, tap.slice, ivec2(tap.texel.x - 1, tap.texel.y), receiver.posL);
  DepthPoint right = depthPointAt(map, tables, tap.slice, ivec2(tap.texel.x + 1, tap.texel.y), receiver.posL);
  DepthPoint above = depthPointAt(map, tables, tap.slice, ivec2(tap.texel.x, tap.texel.y - 1), receiver.posL);
  DepthPoint below = depthPointAt(map, tables, tap.slice, ivec2(tap.texel.x, tap.texel.y + 1), receiver.posL);
  PlaneDepth own = receiverPlaneDepth(map, tap.slice, receiver, tap.ray);
  float slope = mapDepthSlope(map, tap.slice, center.posL, tap.ray.dir);
  float zLeft = left.held ? left.depth : tap.z1;
  float zRight = right.held ? right.depth : tap.z1;
  float zAbove = above.held ? above.depth : tap.z1;
  float zBelow = below.held ? below.depth : tap.z1;
  float rounding = max(depthRounding(map, tap.z1, zLeft, zAbove), depthRounding(map, tap.z1, zRight, zBelow));
  if (own.depth - rounding <= tap.z1) return true;
  float error = tables.endMargin + rounding / slope;
  return !(isBehindDepths(center, left, above, tap.ray.dir, receiver.posL, error) &&
           isBehindDepths(center, right, above, tap.ray.dir, receiver.posL, error) &&
           isBehindDepths(center, left, below, tap.ray.dir, receiver.posL, error) &&
           isBehindDepths(center, right, below, tap.ray.dir, receiver.posL, error));
}

GNOMON_SHARED_END
#endif
