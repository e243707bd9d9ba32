// Four corners that enclose what a triangle covers of a slice of a paraboloid map, on the slice's plane (x, y), rim at
// 1: what the rasterizer is given. It may enclose more, since each texel is decided by its own ray
// (ray_triangle.glsl), never less.
//
// Great circles project to circles: with n = (n.x, n.y, n.w) unit (w along the slice's axis) and c = (n.x, n.y)/n.w
//     n . (2 x, 2 y, 1 - x^2 - y^2) = 0
// is the circle about c of radius 1/|n.w|, which meets the rim at two opposite points.
#ifndef GNOMON_PARABOLOID_BOUND_GLSL
#define GNOMON_PARABOLOID_BOUND_GLSL

#include "shared/map.glsl"
#include "shared/ray_triangle.glsl"

GNOMON_SHARED_BEGIN

struct QuadBound {
  vec2 p0, p1, p2, p3;  // in order around it; all equal where there is nothing to draw
};

GNOMON_FN QuadBound emptyBound() {
  QuadBound bound;
  bound.p0 = bound.p1 = bound.p2 = bound.p3 = vec2(0.0f, 0.0f);
  return bound;
}

// A corner in the slice's frame: third component along the axis it looks.
GNOMON_FN vec3 sliceFromLight(int slice, vec3 posL) { return vec3(posL.x, posL.y, posL.z * paraboloidAxisZ(slice)); }

// How far the arc between two points of the disc bulges from its chord. The arc is at most half its circle, since the
// circle meets the rim at opposite points: sagitta = r - sqrt(r^2 - h^2), h half the chord.
GNOMON_FN float arcBulge(vec3 p, vec3 q, vec2 chord) {
  vec3 normal = edgePlane(p, q);
  float square = dot(normal, normal);
  if (square == 0.0f) return length(chord);
  float curvature2 = normal.z * normal.z / square;
  float half2 = 0.25f * dot(chord, chord);
  return half2 * sqrt(curvature2) / (1.0f + sqrt(max(1.0f - half2 * curvature2, 0.0f)));
}

// All corners in the hemisphere: the triangle of the chords, widened by the largest bulge and `margin`. That is either
// the triangle grown about the centre of its inner circle, or a box along its longest side, whichever is smaller.
GNOMON_FN QuadBound chordBound(vec2 a, vec2 b, vec2 c, float widen) {
  vec2 ab = b - a;
  vec2 bc = c - b;
  vec2 ca = a - c;
  float lc = length(ab);
  float la = length(bc);
  float lb = length(ca);
  float perimeter = la + lb + lc;
  float area2 = abs(ab.x * bc.y - ab.y * bc.x);
  float longest = max(la, max(lb, lc));
  vec2 along = vec2(1.0f, 0.0f);
  if (longest > 0.0f) along = longest == lc ? ab * (1.0f / lc) : (longest == la ? bc * (1.0f / la) : ca * (1.0f / lb));
  float height = longest > 0.0f ? area2 / longest : 0.0f;
  float grown = area2 + widen * perimeter;  // area2 * (1 + widen / radius of the inner circle)
  QuadBound bound;
  // grown^2 / (2 area2) < (longest + 2 widen) (height + 2 widen)
  if (grown * grown < 2.0f * area2 * (longest + 2.0f * widen) * (height + 2.0f * widen)) {
    vec2 center = (a * la + b * lb + c * lc) * (1.0f / perimeter);
    float scale = grown / area2;
    bound.p0 = center + (a - center) * scale;
    bound.p1 = center + (b - center) * scale;
    bound.p2 = center + (c - center) * scale;
    bound.p3 = bound.p2;
    return bound;
  }
  vec2 across = vec2(-along.y, along.x);
  vec2 u = vec2(dot(a, along), dot(a, across));
  vec2 v = vec2(dot(b, along), dot(b, across));
  vec2 w = vec2(dot(c, along), dot(c, across));
  vec2 low = min(u, min(v, w)) - vec2(widen, widen);
  vec2 high = max(u, max(v, w)) + vec2(widen, widen);
  bound.p0 = along * low.x + across * low.y;
  bound.p1 = along * high.x + across * low.y;
  bound.p2 = along * high.x + across * high.y;
  bound.p3 = along * low.x + across * high.y;
  return bound;
}

struct Box2 {
  vec2 low, high;
};

GNOMON_FN Box2 including(Box2 box, vec2 p) {
  box.low = min(box.low, p);
  box.high = max(box.high, p);
  return box;
}

// Whether a direction on the great circle through p and q lies between them; a hundred-thousandth of a radian more,
// since what lies just beyond an end is as far out as the end.
GNOMON_FN bool isOnArc(vec3 normal, vec3 p, vec3 q, vec2 at) {
  vec3 dir = vec3(2.0f * at.x, 2.0f * at.y, 1.0f - dot(at, at));
  return dot(cross(normal, p), dir) >= -1e-5f * length(p) && dot(cross(q, normal), dir) >= -1e-5f * length(q);
}

// Where the circle of `normal` reaches farthest along e: c + e / |n.w|. Along e that is (1 + s)/|n.w| with s = +-n.e,
// and where s nears -1, 1 + s = (n.w^2 + (n.e')^2) / (1 - s) keeps its digits; e' stands across e.
GNOMON_FN Box2 includingExtreme(Box2 box, vec3 normal, vec3 p, vec3 q, vec2 e, float rim2) {
  float w = abs(normal.z);
  if (w == 0.0f) return box;  // a straight line reaches farthest at its ends
  float turn = normal.z > 0.0f ? 1.0f : -1.0f;
  float s = turn * (normal.x * e.x + normal.y * e.y);
  float across = turn * (normal.y * e.x - normal.x * e.y);
  float reach = s > 0.0f ? (1.0f + s) / w : (w * w + across * across) / (w * (1.0f - s));
  vec2 at = e * reach + vec2(-e.y, e.x) * (across / w);
  if (dot(at, at) <= rim2 && isOnArc(normal, p, q, at)) return including(box, at);
  return box;
}

// What an edge contributes: where it runs farthest along each axis, and where it crosses the rim.
GNOMON_FN Box2 includingEdge(Box2 box, vec3 p, vec3 q, float rim) {
  vec3 normal = edgePlane(p, q);
  float size = length(normal);
  if (size == 0.0f) return box;
  normal = normal * (1.0f / size);
  float rim2 = rim * rim;
  box = includingExtreme(box, normal, p, q, vec2(1.0f, 0.0f), rim2);
  box = includingExtreme(box, normal, p, q, vec2(-1.0f, 0.0f), rim2);
  box = includingExtreme(box, normal, p, q, vec2(0.0f, 1.0f), rim2);
  box = includingExtreme(box, normal, p, q, vec2(0.0f, -1.0f), rim2);
  // 2 (n.x x + n.y y) = n.w (rim^2 - 1)
  float flat_ = length(vec2(normal.x, normal.y));
  if (flat_ == 0.0f) return box;
  vec2 e = vec2(normal.x, normal.y) * (1.0f / flat_);
  float cosine = normal.z * (rim2 - 1.0f) / (2.0f * rim * flat_);
  if (abs(cosine) > 1.0f) return box;
  float sine = sqrt(1.0f - cosine * cosine);
  vec2 left = (e * cosine + vec2(-e.y, e.x) * sine) * rim;
  vec2 right = (e * cosine - vec2(-e.y, e.x) * sine) * rim;
  if (isOnArc(normal, p, q, left)) box = including(box, left);
  if (isOnArc(normal, p, q, right)) box = including(box, right);
  return box;
}

// Some corners behind the light: the box of the part within the rim, whose outermost points are corners, places where
// an arc runs farthest or crosses the rim, and places of the rim inside the triangle.
GNOMON_FN QuadBound rimBound(int slice, LightTriangle triangle, vec3 a, vec3 b, vec3 c, float rim, float margin) {
  Box2 box;
  box.low = vec2(2.0f, 2.0f);
  box.high = vec2(-2.0f, -2.0f);
  float rimW = (1.0f - rim * rim) / (1.0f + rim * rim);
  if (a.z >= rimW * length(a)) box = including(box, vec2(a.x, a.y) * (1.0f / (length(a) + a.z)));
  if (b.z >= rimW * length(b)) box = including(box, vec2(b.x, b.y) * (1.0f / (length(b) + b.z)));
  if (c.z >= rimW * length(c)) box = including(box, vec2(c.x, c.y) * (1.0f / (length(c) + c.z)));
  box = includingEdge(box, a, b, rim);
  box = includingEdge(box, b, c, rim);
  box = includingEdge(box, c, a, rim);
  for (int i = 0; i < 4; ++i) {
    float along = i < 2 ? rim : -rim;
    vec2 at = (i & 1) == 0 ? vec2(along, 0.0f) : vec2(0.0f, along);
    vec3 dir = sliceFromLight(slice, vec3(2.0f * at.x, 2.0f * at.y, 1.0f - rim * rim));
    if (isWithin(sideDistances(triangle, dir))) box = including(box, at);
  }
  if (box.low.x > box.high.x) return emptyBound();
  vec2 low = max(box.low - vec2(margin, margin), vec2(-rim, -rim));
  vec2 high = min(box.high + vec2(margin, margin), vec2(rim, rim));
  QuadBound bound;
  bound.p0 = low;
  bound.p1 = vec2(high.x, low.y);
  bound.p2 = high;
  bound.p3 = vec2(low.x, high.y);
  return bound;
}

// What both kinds of bounds begin with.
struct BoundBasis {
  vec3 a, b, c;  // corners in the slice's frame
  float la, lb, lc;  // their lengths
  float rim, margin;
  bool seen;     // or else all corners lie beyond the rim, which is a convex cap: so does the triangle
  bool isAhead;  // all corners are in the hemisphere
};

GNOMON_FN BoundBasis boundBasis(int side, int slice, LightTriangle triangle) {
  BoundBasis basis;
  // Centres of texels that the rim touches lie at most half a diagonal, 0.71 texels, beyond it; a texel is 2 / side.
  basis.rim = 1.0f + 1.5f / float(side);
  // The rasterizer rounds corners to 1/256 of a texel, and the corners here are good to a few 1e-7; those of pieces
  // (paraboloid_pieces.glsl) to 2^-23 times the 32 that isWorthHalving allows, 4e-6.
  basis.margin = 0.0625f / float(side) + 5e-6f;
  basis.a = sliceFromLight(slice, triangle.a);
  basis.b = sliceFromLight(slice, triangle.b);
  basis.c = sliceFromLight(slice, triangle.c);
  basis.la = length(basis.a);
  basis.lb = length(basis.b);
  basis.lc = length(basis.c);
  float rimW = (1.0f - basis.rim * basis.rim) / (1.0f + basis.rim * basis.rim);
  basis.seen = !(basis.a.z < rimW * basis.la && basis.b.z < rimW * basis.lb && basis.c.z < rimW * basis.lc);
  basis.isAhead = basis.a.z >= 0.0f && basis.b.z >= 0.0f && basis.c.z >= 0.0f && basis.la != 0.0f &&
                  basis.lb != 0.0f && basis.lc != 0.0f;
  return basis;
}

GNOMON_FN QuadBound boundAhead(BoundBasis basis) {
  vec2 pa = vec2(basis.a.x, basis.a.y) * (1.0f / (basis.la + basis.a.z));
  vec2 pb = vec2(basis.b.x, basis.b.y) * (1.0f / (basis.lb + basis.b.z));
  vec2 pc = vec2(basis.c.x, basis.c.y) * (1.0f / (basis.lc + basis.c.z));
  float bulge = max(arcBulge(basis.a, basis.b, pb - pa),
                    max(arcBulge(basis.b, basis.c, pc - pb), arcBulge(basis.c, basis.a, pa - pc)));
  return chordBound(pa, pb, pc, bulge + basis.margin);
}

GNOMON_FN QuadBound paraboloidBound(int side, int slice, LightTriangle triangle) {
  BoundBasis basis = boundBasis(side, slice, triangle);
  if (!basis.seen) return emptyBound();
  if (!basis.isAhead) return rimBound(slice, triangle, basis.a, basis.b, basis.c, basis.rim, basis.margin);
  return boundAhead(basis);
}

GNOMON_SHARED_END
#endif
