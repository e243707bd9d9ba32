// A walk over a mesh, as the light sees it: from a point of one triangle along a straight line towards a point of another,
// from neighbour to neighbour, to learn whether the first triangle's surface is what shadows that point. The idea and
// the derivations are in docs/witness.md.
//
//   light  *                 T   the triangle a texel sees, q the point of it on the texel's ray
//         /|\                R   the receiver's triangle, P its point
//        / | \               T*  the triangle of T's surface that covers P's direction
//       q--+  \ .
//      T    \T*\             The walk goes by side tests alone: on which side of the plane through the light and an edge
//            \--\            a point lies. Two triangles that share an edge get opposite signs of one number for it, so
//                \           that no step falls between them.
//          ------P---R
#ifndef GNOMON_SHEET_WALK_GLSL
#define GNOMON_SHEET_WALK_GLSL

#include "shared/bias_params.glsl"
#include "shared/lang.glsl"
#include "shared/lookup_tables.glsl"
#include "shared/ray_triangle.glsl"

GNOMON_SHARED_BEGIN

// The longest walk that was met on 22 scenes, at 128 to 1024 texels, took 61 steps (docs/witness.md).
const int kMostWalkSteps = 128;

struct SheetWalk {
  int end;  // kWalk*
  int steps;
  PlacedTriangle at;  // where it ended
  vec3 posL;          // of a witness: T*'s point on P's ray
};

// Twice det(a, b, p), or of parallel light det(b - a, d, p - a): positive on the one side of the plane through the light
// and the edge, negative on the other. Exchanging a and b changes the sign and no other bit.
GNOMON_FN float lightSide(LookupTables tables, vec3 a, vec3 b, vec3 p) {
  if (tables.positional == 1.0f) {
    vec3 normal = edgePlane(a, b);
    GNOMON_PRECISE float side = normal.x * p.x + normal.y * p.y + normal.z * p.z;
    return side;
  }
  GNOMON_PRECISE vec3 sum = a + b;
  GNOMON_PRECISE vec3 along = b - a;
  GNOMON_PRECISE float x = 2.0f * p.x - sum.x;
  GNOMON_PRECISE float y = 2.0f * p.y - sum.y;
  GNOMON_PRECISE float side = along.x * y - along.y * x;
  return side;
}

GNOMON_FN float largestOf(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// How far the light's ray to p meets a triangle's plane before p, metres along the receiver's normal, may be off by
// rounding; and what is nearer than the scene's own margin is the receiver's surface in any case.
//
// Unit roundoff is u = 2^-24, coordinates are at most C in L and O + C in the world, O the origin of L. A coordinate of p
// is off by 5u (O + C), of weights and sums over the corners of R, and 5u C, of lightFromWorld; a corner of T* by 5u C;
// so P lies off R's plane and T*'s plane off T* by at most sqrt(3) (5u O + 15u C) together. Side tests are off by
// 16u C across the edge, and P by what its coordinates are: it may lie so far aside from T* as the light sees it. The
// triangle's slant turns what is aside into distance along the ray: over the cosine of incidence. The normal is exact
// (exactNormal), so that slender triangles are no worse than others. In all less than 40u (O + C) (1 + 1 / cosine).
const float kSheetRounding = 40.0f * 5.9604645e-8f;

GNOMON_FN float sheetMargin(LookupTables tables, vec3 a, vec3 b, vec3 c, vec3 p, float cosine) {
  float coordinate =
      largestOf(tables.frame.originW) + max(max(largestOf(a), largestOf(b)), max(largestOf(c), largestOf(p)));
  return tables.endMargin + kSheetRounding * coordinate * (1.0f + 1.0f / cosine);
}

// Unit, away from the light.
GNOMON_FN vec3 lightDirection(LookupTables tables, vec3 posL) {
  if (tables.positional == 1.0f) return unitVector(posL);
  return vec3(0.0f, 0.0f, -1.0f);
}

GNOMON_FN int rowAfter(int row, int turn) { return (row + turn + 3) % 3; }

// The state of a walk: a triangle whose corners p0, p1, p2 wind so that every edge's inner side is positive, the light
// sees them so; and on which sides P lies. The walk came in through p0 p1.
struct SheetStep {
  PlacedTriangle at;
  vec3 p0, p1, p2;
  float s01, s12, s20;
  int first;  // the row of p0
  int turn;   // from the row of p0 to that of p1, and on: 1 or -1
};

// Of the triangle where a walk begins. `seen`: whether the light sees an area at all.
GNOMON_FN SheetStep firstStep(LookupTables tables, PlacedTriangle start, mat4 fromMesh, vec3 target,
                              GNOMON_OUT(bool) seen) {
  SheetStep step;
  step.at = start;
  step.p0 = cornerInL(tables, fromMesh, meshRow(tables, 3u * start.triangle).corner);
  step.p1 = cornerInL(tables, fromMesh, meshRow(tables, 3u * start.triangle + 1u).corner);
  step.p2 = cornerInL(tables, fromMesh, meshRow(tables, 3u * start.triangle + 2u).corner);
  step.first = 0;
  step.turn = 1;
  float area = lightSide(tables, step.p0, step.p1, step.p2);
  seen = area != 0.0f;
  if (area < 0.0f) {
    vec3 swap = step.p1;
    step.p1 = step.p2;
    step.p2 = swap;
    step.turn = -1;
  }
  step.s01 = lightSide(tables, step.p0, step.p1, target);
  step.s12 = lightSide(tables, step.p1, step.p2, target);
  step.s20 = lightSide(tables, step.p2, step.p0, target);
  return step;
}

GNOMON_FN SheetStep turnedOnce(SheetStep step) {
  SheetStep turned = step;
  turned.p0 = step.p1;
  turned.p1 = step.p2;
  turned.p2 = step.p0;
  turned.s01 = step.s12;
  turned.s12 = step.s20;
  turned.s20 = step.s01;
  turned.first = rowAfter(step.first, step.turn);
  return turned;
}

// The point of a triangle where the ray through `along` meets it, or nearest to that: the rasterizer decides on a grid of
// 1/256 texel, so that the ray may pass just outside, and a line from there could cross the wrong edge.
GNOMON_FN vec3 clampedToTriangle(LookupTables tables, vec3 a, vec3 b, vec3 c, vec3 along) {
  float wa = max(lightSide(tables, b, c, along), 0.0f);
  float wb = max(lightSide(tables, c, a, along), 0.0f);
  float wc = max(lightSide(tables, a, b, along), 0.0f);
  float sum = wa + wb + wc;
  if (!(sum > 0.0f)) return a;
  return (a * wa + b * wb + c * wc) * (1.0f / sum);
}

// Where the triangle of a step stands before the plane of the receiver that it covers.
GNOMON_FN SheetWalk judgeCover(LookupTables tables, SheetStep step, vec3 target, vec3 normalL, int steps) {
  SheetWalk walk;
  walk.end = kWalkBehind;
  walk.steps = steps;
  walk.at = step.at;
  walk.posL = target;
  float sides = step.s01 + step.s12 + step.s20;
  if (!(sides > 0.0f)) return walk;
  vec3 dir = lightDirection(tables, target);
  vec3 normal = exactNormal(step.p0, step.p1, step.p2);
  float approach = dot(normal, dir);
  if (approach == 0.0f) return walk;
  // Of the corners the one that weighs most: near to where the ray meets the plane.
  vec3 corner = step.p0;
  if (step.s20 > step.s12) corner = step.p1;
  if (step.s01 > max(step.s12, step.s20)) corner = step.p2;
  float along = dot(normal, corner - target) / approach;  // negative towards the light
  float height = dot(normalL, dir) * along;
  float cosine = abs(approach) / sqrt(dot(normal, normal));
  walk.posL = target + dir * along;
  if (!(height > sheetMargin(tables, step.p0, step.p1, step.p2, target, cosine))) return walk;
  walk.end = kWalkWitness;
  if (tables.masked == 1) {
    float scale = 1.0f / sides;
    int second = rowAfter(step.first, step.turn);
    vec3 ofRows = vec3(0.0f, 0.0f, 0.0f);
    ofRows[step.first] = step.s12 * scale;
    ofRows[second] = step.s20 * scale;
    ofRows[rowAfter(second, step.turn)] = step.s01 * scale;
    if (isMeshHole(tables, step.at.triangle, step.at.instance, ofRows)) walk.end = kWalkHole;
  }
  return walk;
}

// Whether the surface, where the walk leaves a triangle over the edge from x to y, has come down to the plane of the
// receiver at `target`. The height over a plane is straight between two edges.
GNOMON_FN bool meetsPlane(LookupTables tables, vec3 x, vec3 y, vec3 from, vec3 target, vec3 normalL) {
  float ofX = abs(lightSide(tables, from, target, y));
  float ofY = abs(lightSide(tables, from, target, x));
  vec3 crossing = ofX + ofY > 0.0f ? (x * ofX + y * ofY) * (1.0f / (ofX + ofY)) : x;
  return dot(normalL, crossing - target) <= tables.endMargin;
}

// From triangle `start`, where the light's ray through `along` meets it, to `target`, whose plane has the unit normal
// `normalL` towards the light. `own`: R. With `toPlane` the walk also ends, kWalkBehind, where the surface comes down to
// the plane.
GNOMON_FN SheetWalk walkSheet(LookupTables tables, PlacedTriangle start, vec3 along, vec3 target, vec3 normalL,
                              PlacedTriangle own, bool toPlane) {
  SheetWalk walk;
  walk.end = kWalkReceiver;
  walk.steps = 0;
  walk.at = start;
  walk.posL = target;
  if (start.triangle == own.triangle && start.instance == own.instance) return walk;
  mat4 fromMesh = placeOf(tables, start.instance);
  bool seen;
  SheetStep step = firstStep(tables, start, fromMesh, target, seen);
  walk.end = kWalkFold;
  if (!seen) return walk;
  vec3 from = clampedToTriangle(tables, step.p0, step.p1, step.p2, along);
  // P lies within the edge that the walk "came in" through.
  if (step.s01 < 0.0f) step = turnedOnce(step);
  if (step.s01 < 0.0f) step = turnedOnce(step);
  if (step.s01 < 0.0f) return walk;
  for (int i = 0; i < kMostWalkSteps; ++i) {
    if (step.s12 >= 0.0f && step.s20 >= 0.0f) return judgeCover(tables, step, target, normalL, i);
    // P lies beyond one edge, or beyond both: then the line passes their common corner on one side.
    bool through12 = step.s12 < 0.0f && (step.s20 >= 0.0f || lightSide(tables, from, target, step.p2) > 0.0f);
    walk.at = step.at;
    walk.steps = i;
    int opposite = through12 ? step.first : rowAfter(step.first, step.turn);
    uint link = meshRow(tables, 3u * step.at.triangle + uint(opposite)).link;
    vec3 x = through12 ? step.p1 : step.p2;
    vec3 y = through12 ? step.p2 : step.p0;
    walk.end = kWalkBehind;
    if (toPlane && meetsPlane(tables, x, y, from, target, normalL)) return walk;
    walk.end = kWalkOpen;
    if (link == kNoLink) return walk;
    float back = through12 ? -step.s12 : -step.s20;
    int row = linkedRow(link);
    vec3 n = cornerInL(tables, fromMesh, meshRow(tables, 3u * linkedTriangle(link) + uint(row)).corner);
    // On the same side of the edge as the triangle before: the surface turns back. Exactly in the edge's plane it has no
    // area, or is seen edge-on, and leads on.
    walk.end = kWalkFold;
    if (lightSide(tables, y, x, n) < 0.0f) return walk;
    step.at.triangle = linkedTriangle(link);
    walk.at = step.at;
    walk.steps = i + 1;
    walk.end = kWalkReceiver;
    if (step.at.triangle == own.triangle && step.at.instance == own.instance) return walk;
    if (linkTurns(link)) step.turn = -step.turn;
    step.first = rowAfter(row, step.turn);
    step.p0 = y;
    step.p1 = x;
    step.p2 = n;
    step.s01 = back;
    step.s12 = lightSide(tables, x, n, target);
    step.s20 = lightSide(tables, n, y, target);
  }
  walk.end = kWalkAborted;
  return walk;
}

GNOMON_SHARED_END
#endif
