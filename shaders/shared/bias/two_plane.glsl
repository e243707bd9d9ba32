// Two planes: a receiver is in shadow only where both the receiver's plane and the caster's say so.
//
//   adaptive's test (Dou et al. 2014) extends the receiver's plane to the texel's ray: wrong in a valley, where the plane
//   passes below the surface that the texel sees. Its mirror extends the caster's plane to the receiver's ray: wrong on a
//   ridge. On a crease of two planes one of the two is always right, and light is what it says:
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

// The margin of the caster's plane at p: it is known at the triangle, whose corners are off by rounding, and drawn out to p
// its angle's error, a corner's over the triangle's least height, counts with the distance. For the rest see
// sheetMargin().
GNOMON_FN float planeMargin(LookupTables tables, vec3 a, vec3 b, vec3 c, vec3 p, float doubleArea) {
  vec3 ab = b - a;
  vec3 bc = c - b;
  vec3 ca = a - c;
  float longest = sqrt(max(max(dot(ab, ab), dot(bc, bc)), dot(ca, ca)));
  vec3 out_ = p - a;
  float coordinate = largestOf(tables.frame.originW) + max(max(largestOf(a), largestOf(b)), max(largestOf(c), largestOf(p)));
  return tables.endMargin + kSheetRounding * coordinate * (1.0f + sqrt(dot(out_, out_)) * longest / doubleArea);
}

GNOMON_FN bool twoPlaneLit(LookupTables tables, Receiver receiver, PlacedTriangle caster, Ray ray) {
  mat4 fromMesh = placeOf(tables, caster.instance);
  vec3 a = cornerInL(tables, fromMesh, meshRow(tables, 3u * caster.triangle).corner);
  vec3 b = cornerInL(tables, fromMesh, meshRow(tables, 3u * caster.triangle + 1u).corner);
  vec3 c = cornerInL(tables, fromMesh, meshRow(tables, 3u * caster.triangle + 2u).corner);
  vec3 scaled = exactNormal(a, b, c);
  float doubleArea = sqrt(dot(scaled, scaled));
  float area = lightSide(tables, a, b, c);
  if (!(doubleArea > 0.0f) || area == 0.0f) return true;
  vec3 q = area > 0.0f ? clampedToTriangle(tables, a, b, c, alongRay(tables, ray))
                       : clampedToTriangle(tables, a, c, b, alongRay(tables, ray));
  float before = dot(receiver.normalL, q - receiver.posL);
  vec3 normal = scaled * (1.0f / doubleArea);
  float cosine = abs(dot(normal, lightDirection(tables, q)));
  if (before <= sheetMargin(tables, a, b, c, q, cosine)) return true;
  float lightSideOf = tables.positional == 1.0f ? -dot(normal, a) : normal.z;
  if (lightSideOf < 0.0f) normal = -normal;
  return dot(normal, receiver.posL - a) >= -planeMargin(tables, a, b, c, receiver.posL, doubleArea);
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

// How far off a stored depth may be: a few 2^-24 of the range, and the rasterizer's plane equation, whose products are as
// large as the plane's change across the whole slice (tests/omni/rendered_slices_test.cpp measures it). The plane at P
// is a mean of three depths, with weights of at most 1, 1/2 and 1/2 in size: twice one depth's error.
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
  float rounding = max(depthRounding(map, tap.z1, left.held ? left.depth : tap.z1, above.held ? above.depth : tap.z1),
                       depthRounding(map, tap.z1, right.held ? right.depth : tap.z1, below.held ? below.depth : tap.z1));
  if (own.depth - rounding <= tap.z1) return true;
  float error = tables.endMargin + rounding / slope;
  return !(isBehindDepths(center, left, above, tap.ray.dir, receiver.posL, error) &&
           isBehindDepths(center, right, above, tap.ray.dir, receiver.posL, error) &&
           isBehindDepths(center, left, below, tap.ray.dir, receiver.posL, error) &&
           isBehindDepths(center, right, below, tap.ray.dir, receiver.posL, error));
}

GNOMON_SHARED_END
#endif
