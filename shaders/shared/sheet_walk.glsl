// A walk over a mesh, as the light sees it: from a point of one triangle along a straight line towards a point of
// another, from neighbour to neighbour, to learn whether the first triangle's surface is what shadows that point. The
// idea and the derivations are in docs/witness.md.
//
//   light  *                 T   the triangle a texel sees, q the point of it on the texel's ray
//         /|\                R   the receiver's triangle, P its point
//        / | \               T*  the triangle of T's surface that covers P's direction
//       q--+  \ .
//      T    \T*\             The walk goes by side tests alone: on which side of the plane through the light and an
//            \--\            edge a point lies. Two triangles that share an edge get opposite signs of one number for
//                \           it, so that no step falls between them.
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

const int kWalkOn = -1;  // not at its end yet

struct SheetWalk {
  int end;  // kWalk*
  int steps;
  PlacedTriangle at;  // where it is, or ended
  int turn;           // 1: side tests of its edges are positive within; -1: negative; 0: not known yet
  vec3 from;          // where it began
  vec3 posL;          // of a witness: T*'s point on P's ray
  bool planesLit;     // what two-plane says of the triangle where it began
};

GNOMON_FN SheetWalk beginWalk(PlacedTriangle start) {
  SheetWalk walk;
  walk.end = kWalkOn;
  walk.steps = 0;
  walk.at = start;
  walk.turn = 0;
  walk.from = vec3(0.0f, 0.0f, 0.0f);
  walk.posL = walk.from;
  walk.planesLit = true;
  return walk;
}

// Twice det(a, b, p), or of parallel light det(b - a, d, p - a): positive on the one side of the plane through the
// light and the edge, negative on the other. Exchanging a and b changes the sign and no other bit.
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

// How high over the receiver's plane at p a triangle's point on p's ray must be to shadow p, metres: the scene's own
// margin, and what floats may be off.
//
// Unit roundoff is u = 2^-24; coordinates are at most W in the world, C in L, and O is the origin of L.
// - p lies off the receiver's plane: a coordinate is off by 5u W, of weights and sums over the corners, and by 5u C, of
//   lightFromWorld; along a normal sqrt(3) times that. u W is at most an eighth of the scene's margin.
// - Where the ray meets the triangle is off along the ray: the triangle's corners are off by 9u C along its normal, a
//   side test by 16u C across its edge, p by 7u (O + C) + 7u C aside, and the triangle's slant turns that into
//   distance: over the cosine of incidence. As height over the receiver's plane it is less, by the cosine of its own.
//   The triangle's normal is exact (exactNormal), so that slender triangles are no worse than others.
const float kPointRounding = 9.0f * 5.9604645e-8f;
const float kSheetRounding = 40.0f * 5.9604645e-8f;

GNOMON_FN float sheetRounding(LookupTables tables, vec3 a, vec3 b, vec3 c, vec3 p) {
  float inL = max(max(largestOf(a), largestOf(b)), max(largestOf(c), largestOf(p)));
  return kSheetRounding * (largestOf(tables.frame.originW) + inL);
}

// `slant`: the cosine of the light's incidence on the receiver, over that on the triangle.
GNOMON_FN float sheetMargin(LookupTables tables, vec3 p, float rounding, float slant) {
  return 2.1f * tables.endMargin + kPointRounding * largestOf(p) + rounding * slant;
}

// Unit, away from the light.
GNOMON_FN vec3 lightDirection(LookupTables tables, vec3 posL) {
  if (tables.positional == 1.0f) return unitVector(posL);
  return vec3(0.0f, 0.0f, -1.0f);
}

GNOMON_FN int rowAfter(int row, int turn) { return (row + turn + 3) % 3; }

// A triangle of a walk in L, the side tests of a point by rows (positive within), and its plane.
struct SheetTriangle {
  vec3 a, b, c;
  uint linkA, linkB, linkC;
  vec3 normal;  // to the light's side; any length
};

GNOMON_FN SheetTriangle sheetTriangle(LookupTables tables, PlacedTriangle placed) {
  mat4 fromMesh = placeOf(tables, placed.instance);
  MeshRow a = meshRow(tables, 3u * placed.triangle);
  MeshRow b = meshRow(tables, 3u * placed.triangle + 1u);
  MeshRow c = meshRow(tables, 3u * placed.triangle + 2u);
  SheetTriangle triangle;
  triangle.a = cornerInL(tables, fromMesh, a.corner);
  triangle.b = cornerInL(tables, fromMesh, b.corner);
  triangle.c = cornerInL(tables, fromMesh, c.corner);
  triangle.linkA = a.link;
  triangle.linkB = b.link;
  triangle.linkC = c.link;
  vec3 normal = exactNormal(triangle.a, triangle.b, triangle.c);
  float towardsLight_ = tables.positional == 1.0f ? -dot(normal, triangle.a) : normal.z;
  triangle.normal = towardsLight_ < 0.0f ? -normal : normal;
  return triangle;
}

// Of the edges opposite to each corner.
GNOMON_FN vec3 sideTests(LookupTables tables, SheetTriangle triangle, vec3 p, float turn) {
  return vec3(lightSide(tables, triangle.b, triangle.c, p) * turn, lightSide(tables, triangle.c, triangle.a, p) * turn,
              lightSide(tables, triangle.a, triangle.b, p) * turn);
}

// The point of a triangle where the ray through `along` meets it, or nearest to that: the rasterizer decides on a grid
// of 1/256 texel, so that the ray may pass just outside, and a line from there could cross the wrong edge.
GNOMON_FN vec3 clampedToTriangle(LookupTables tables, SheetTriangle triangle, vec3 along, float turn) {
  vec3 sides = max(sideTests(tables, triangle, along, turn), vec3(0.0f, 0.0f, 0.0f));
  float sum = sides.x + sides.y + sides.z;
  if (!(sum > 0.0f)) return triangle.a;
  return (triangle.a * sides.x + triangle.b * sides.y + triangle.c * sides.z) * (1.0f / sum);
}

// What a triangle is to a receiver at p whose direction it covers: where its plane stands on p's ray.
struct SheetCover {
  vec3 posL;
  bool before;  // the receiver's plane
};

GNOMON_FN SheetCover coverOf(LookupTables tables, SheetTriangle triangle, vec3 sides, vec3 p, vec3 normalL) {
  vec3 dir = lightDirection(tables, p);
  float approach = dot(triangle.normal, dir);
  // Of the corners the one that weighs most: near to where the ray meets the plane.
  vec3 corner = triangle.a;
  if (sides.y > sides.x) corner = triangle.b;
  if (sides.z > max(sides.x, sides.y)) corner = triangle.c;
  float along = dot(triangle.normal, corner - p) / approach;  // negative towards the light
  float cosine = abs(approach) / sqrt(dot(triangle.normal, triangle.normal));
  float facing = dot(normalL, dir);
  float height = facing * along;
  float rounding = sheetRounding(tables, triangle.a, triangle.b, triangle.c, p);
  SheetCover cover;
  cover.posL = p + dir * along;
  // False of what has no plane, too.
  cover.before = height > sheetMargin(tables, p, rounding, abs(facing) / cosine);
  return cover;
}

// Two planes (bias/two_plane.glsl): whether p, with unit normal normalL, is in light by the receiver's plane at the
// triangle's point q or by the triangle's own plane. That is known at the triangle, whose corners are off by rounding,
// and drawn out to p its angle's error, a corner's over the triangle's least height, counts with the distance.
GNOMON_FN bool twoPlanesLight(LookupTables tables, SheetTriangle triangle, vec3 q, vec3 p, vec3 normalL) {
  float doubleArea = sqrt(dot(triangle.normal, triangle.normal));
  if (!(doubleArea > 0.0f)) return true;
  vec3 normal = triangle.normal * (1.0f / doubleArea);
  float rounding = sheetRounding(tables, triangle.a, triangle.b, triangle.c, p);
  vec3 ab = triangle.b - triangle.a;
  vec3 bc = triangle.c - triangle.b;
  vec3 ca = triangle.a - triangle.c;
  float longest = sqrt(max(max(dot(ab, ab), dot(bc, bc)), dot(ca, ca)));
  vec3 out_ = p - triangle.a;
  float drawnOut = 1.0f + sqrt(dot(out_, out_)) * longest / doubleArea;
  return dot(normalL, q - p) <= sheetMargin(tables, p, rounding, 1.0f) ||
         dot(normal, p - triangle.a) >= -(tables.endMargin + rounding * drawnOut);
}

// The same for a walk that is given up, without a margin for the plane drawn out: it is asked for at every beginning,
// and in full would be half of the pass.
GNOMON_FN bool bothPlanesLight(LookupTables tables, SheetTriangle triangle, vec3 q, vec3 p, vec3 normalL) {
  float margin = 2.1f * tables.endMargin + kPointRounding * largestOf(p);
  float behind = -dot(triangle.normal, p - triangle.a);
  bool isBehind = behind > 0.0f && behind * behind > margin * margin * dot(triangle.normal, triangle.normal);
  return dot(normalL, q - p) <= margin || !isBehind;
}

// Whether the surface, where the walk leaves a triangle over the edge from x to y, has come down to the plane of the
// receiver at `target`. The height over a plane is straight between two edges.
GNOMON_FN bool meetsPlane(LookupTables tables, vec3 x, vec3 y, vec3 from, vec3 target, vec3 normalL) {
  float ofX = abs(lightSide(tables, from, target, y));
  float ofY = abs(lightSide(tables, from, target, x));
  vec3 crossing = ofX + ofY > 0.0f ? (x * ofX + y * ofY) * (1.0f / (ofX + ofY)) : x;
  return dot(normalL, crossing - target) <= tables.endMargin;
}

// The row opposite to the edge over which the walk leaves a triangle: the one that P lies beyond; where it lies beyond
// two, the line to P passes their common corner on one side.
GNOMON_FN int exitRow(LookupTables tables, SheetTriangle triangle, vec3 sides, vec3 from, vec3 target, int turn) {
  bool beyondA = sides.x < 0.0f;
  bool beyondB = sides.y < 0.0f;
  bool beyondC = sides.z < 0.0f;
  int meeting = beyondA && beyondB ? 2 : beyondB && beyondC ? 0 : 1;
  vec3 corner = meeting == 0 ? triangle.a : meeting == 1 ? triangle.b : triangle.c;
  bool left = lightSide(tables, from, target, corner) > 0.0f;
  int ofTwo = rowAfter(meeting, left ? turn : -turn);
  int count = (beyondA ? 1 : 0) + (beyondB ? 1 : 0) + (beyondC ? 1 : 0);
  return count == 2 ? ofTwo : beyondA ? 0 : beyondB ? 1 : 2;
}

GNOMON_FN bool isSamePlace(PlacedTriangle a, PlacedTriangle b) {
  return a.triangle == b.triangle && a.instance == b.instance;
}

// One triangle further: from where the light's ray through `along` meets the triangle where the walk begins, towards
// `target`, whose plane has the unit normal `normalL` towards the light. `own`: R. With `toPlane` the walk also ends,
// kWalkBehind, where the surface comes down to the plane.
GNOMON_FN SheetWalk walkOn(LookupTables tables, SheetWalk walk, vec3 along, vec3 target, vec3 normalL,
                           PlacedTriangle own, bool toPlane) {
  SheetWalk next = walk;
  SheetTriangle triangle = sheetTriangle(tables, walk.at);
  float area = lightSide(tables, triangle.a, triangle.b, triangle.c);
  bool begins = walk.turn == 0;
  if (begins) {
    next.turn = area < 0.0f ? -1 : 1;
    next.from = clampedToTriangle(tables, triangle, along, float(next.turn));
    next.planesLit = bothPlanesLight(tables, triangle, next.from, target, normalL);
  }
  float turn = float(next.turn);
  vec3 sides = sideTests(tables, triangle, target, turn);
  bool covers = sides.x >= 0.0f && sides.y >= 0.0f && sides.z >= 0.0f;
  SheetCover cover = coverOf(tables, triangle, sides, target, normalL);
  int row = exitRow(tables, triangle, sides, next.from, target, next.turn);
  uint link = row == 0 ? triangle.linkA : row == 1 ? triangle.linkB : triangle.linkC;
  vec3 x = row == 0 ? triangle.b : row == 1 ? triangle.c : triangle.a;
  vec3 y = row == 0 ? triangle.c : row == 1 ? triangle.a : triangle.b;
  next.posL = cover.posL;
  if (begins && isSamePlace(walk.at, own)) {
    next.end = kWalkReceiver;
  } else if (begins ? area == 0.0f : area * turn < 0.0f) {
    // The surface turns back: the light sees the other side. A triangle that it sees edge-on, or that has no area,
    // leads on, but is no place to begin.
    next.end = kWalkFold;
  } else if (covers) {
    next.end = cover.before && sides.x + sides.y + sides.z > 0.0f ? kWalkWitness : kWalkBehind;
  } else if (sides.x < 0.0f && sides.y < 0.0f && sides.z < 0.0f) {
    next.end = kWalkFold;  // rounding, where the light sees next to no area
  } else if (toPlane && meetsPlane(tables, x, y, next.from, target, normalL)) {
    next.end = kWalkBehind;
  } else if (link == kNoLink) {
    next.end = kWalkOpen;
  } else if (walk.steps >= kMostWalkSteps) {
    next.end = kWalkAborted;
  } else {
    next.steps = walk.steps + 1;
    next.at.triangle = linkedTriangle(link);
    if (linkTurns(link)) next.turn = -next.turn;
    // Known before it is entered: most walks end so, and a turn is a third of a pixel's cost.
    if (isSamePlace(next.at, own)) next.end = kWalkReceiver;
  }
  return next;
}

// Whether a witness has a hole of its alpha mask there.
GNOMON_FN bool isHoleOf(LookupTables tables, SheetWalk walk, vec3 target) {
  SheetTriangle triangle = sheetTriangle(tables, walk.at);
  vec3 sides = sideTests(tables, triangle, target, float(walk.turn));
  return isMeshHole(tables, walk.at.triangle, walk.at.instance, sides * (1.0f / (sides.x + sides.y + sides.z)));
}

// A whole walk.
GNOMON_FN SheetWalk walkSheet(LookupTables tables, PlacedTriangle start, vec3 along, vec3 target, vec3 normalL,
                              PlacedTriangle own, bool toPlane) {
  SheetWalk walk = beginWalk(start);
  while (walk.end == kWalkOn) walk = walkOn(tables, walk, along, target, normalL, own, toPlane);
  if (tables.masked == 1 && walk.end == kWalkWitness && isHoleOf(tables, walk, target)) walk.end = kWalkHole;
  return walk;
}

GNOMON_SHARED_END
#endif
