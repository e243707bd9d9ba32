// Triangles cut into pieces whose edges are nearly straight on a slice of a paraboloid map.
//
// An edge's arc has the curvature |n.w| (paraboloid_bound.glsl) and leaves its chord by the sagitta, at most |n.w|
// chord^2 / 4: cut in the middle, a quarter of that is left on each side. So a triangle is cut in two from the
// middle of the edge that bends most to the corner opposite, and its halves again, until no edge bends too much.
// Where an edge is cut depends on its two ends alone and not on which comes first: triangles that share it are cut
// alike, and no crack opens.
#ifndef GNOMON_PARABOLOID_PIECES_GLSL
#define GNOMON_PARABOLOID_PIECES_GLSL

#include "shared/paraboloid_bound.glsl"

GNOMON_SHARED_BEGIN

struct Piece {
  vec3 a, b, c;  // L
  vec2 uvA, uvB, uvC;
};

// The place on an edge that halves its angle at the light: on (p, q) at |p| : |q|. Without fused products it
// is the same for (q, p).
GNOMON_FN vec3 arcMiddle(vec3 p, vec3 q) {
  GNOMON_PRECISE float lp = length(p);
  GNOMON_PRECISE float lq = length(q);
  GNOMON_PRECISE vec3 fromP = p * lq;
  GNOMON_PRECISE vec3 fromQ = q * lp;
  GNOMON_PRECISE vec3 middle = (fromP + fromQ) * (1.0f / (lp + lq));
  return middle;
}

GNOMON_FN vec2 arcMiddleUv(vec3 p, vec3 q, vec2 uvP, vec2 uvQ) {
  float lp = length(p);
  float lq = length(q);
  return (uvP * lq + uvQ * lp) * (1.0f / (lp + lq));
}

// Where what is drawn with straight edges ends. Centres of held texels lie up to 1.42 / side beyond the rim. Edges
// whose bend is measured have chords of at most c^2 = 9.7 / side: bent at most 1 / side they span 8 / side on a circle
// of radius 1, and where they run straight their depth bounds them, which with t = tan of the angle from the light's
// nearest point of the line bends by (1 + 2 t^2) / (1 + t) > 0.83 of what a shift makes up for.
//  - An edge with both ends out here is not measured, and is as long as two that are: drawn straight it runs up to
//    (2 c)^2 / 8 = 4.9 / side nearer to the centre than its ends.
//  - The rasterizer cuts where the square of the distance to the centre, interpolated, exceeds the rim's; within a
//    triangle it is up to c^2 / 3 too much, which is 1.6 / side of distance.
GNOMON_FN float drawnRim(int side) { return 1.0f + 6.5f / float(side); }

// Along the slice's axis over distance, where what is drawn ends; bounds need no more than the texels and half of one.
GNOMON_FN float piecesRimW(int side, bool drawnStraight) {
  float rim = drawnStraight ? drawnRim(side) : 1.0f + 2.5f / float(side);
  return (1.0f - rim * rim) / (1.0f + rim * rim);
}

// Wider than two discs; the wider the angle the more, so that the longest edge is cut first.
GNOMON_FN float bendBeyondMeasure(vec3 p, vec3 q) { return 5.0f - dot(p, q) / (length(p) * length(q)); }

// How far, on the slice's plane, an edge drawn straight is from where it belongs. Ends in the slice's frame.
// Nothing of an edge beyond the rim is seen; of one that reaches there the projection may be anywhere until it
// spans less than 60 degrees.
GNOMON_FN float edgeBend(vec3 p, vec3 q, float rimW) {
  float lp = length(p);
  float lq = length(q);
  if (p.z < rimW * lp && q.z < rimW * lq) return 0.0f;
  if (lp == 0.0f || lq == 0.0f) return 0.0f;
  if ((p.z < 0.0f || q.z < 0.0f) && dot(p, q) < 0.5f * lp * lq) return bendBeyondMeasure(p, q);
  vec2 chord = vec2(q.x, q.y) * (1.0f / (lq + q.z)) - vec2(p.x, p.y) * (1.0f / (lp + p.z));
  return arcBulge(p, q, chord);
}

// The same of depth: distances that are interpolated along the chord miss the middle's by `off`, as much as a shift by
// off / (change of distance along the chord) would, or what half that width is at the middle's distance, seen face on.
GNOMON_FN float edgeSink(vec3 p, vec3 q, float rimW) {
  float lp = length(p);
  float lq = length(q);
  if (p.z < rimW * lp && q.z < rimW * lq) return 0.0f;
  if (lp == 0.0f || lq == 0.0f) return 0.0f;
  if ((p.z < 0.0f || q.z < 0.0f) && dot(p, q) < 0.5f * lp * lq) return bendBeyondMeasure(p, q);
  vec2 chord = vec2(q.x, q.y) * (1.0f / (lq + q.z)) - vec2(p.x, p.y) * (1.0f / (lp + p.z));
  float size = length(chord);
  if (size == 0.0f) return 0.0f;
  float middle = length(arcMiddle(p, q));
  // Between a rim's texel and the pole's, a unit of the plane is 1 to 2 radians.
  return (0.5f * (lp + lq) - middle) / (abs(lp - lq) / size + middle);
}

struct Bends {
  float a, b, c;  // of the edges opposite
};

GNOMON_FN Bends pieceBends(int side, int slice, Piece piece, bool drawnStraight) {
  vec3 a = sliceFromLight(slice, piece.a);
  vec3 b = sliceFromLight(slice, piece.b);
  vec3 c = sliceFromLight(slice, piece.c);
  float rimW = piecesRimW(side, drawnStraight);
  Bends bends;
  bends.a = edgeBend(b, c, rimW);
  bends.b = edgeBend(c, a, rimW);
  bends.c = edgeBend(a, b, rimW);
  if (drawnStraight) {
    bends.a = max(bends.a, edgeSink(b, c, rimW));
    bends.b = max(bends.b, edgeSink(c, a, rimW));
    bends.c = max(bends.c, edgeSink(a, b, rimW));
  }
  return bends;
}

GNOMON_FN float worstBend(Bends bends) { return max(bends.a, max(bends.b, bends.c)); }

struct PieceHalves {
  Piece first, second;
};

GNOMON_FN PieceHalves halvesOf(int side, int slice, Piece piece, bool drawnStraight) {
  Bends bends = pieceBends(side, slice, piece, drawnStraight);
  float worst = worstBend(bends);
  PieceHalves halves;
  halves.first = piece;
  halves.second = piece;
  if (bends.a == worst) {
    halves.first.c = halves.second.b = arcMiddle(piece.b, piece.c);
    halves.first.uvC = halves.second.uvB = arcMiddleUv(piece.b, piece.c, piece.uvB, piece.uvC);
  } else if (bends.b == worst) {
    halves.first.a = halves.second.c = arcMiddle(piece.c, piece.a);
    halves.first.uvA = halves.second.uvC = arcMiddleUv(piece.c, piece.a, piece.uvC, piece.uvA);
  } else {
    halves.first.b = halves.second.a = arcMiddle(piece.a, piece.b);
    halves.first.uvB = halves.second.uvA = arcMiddleUv(piece.a, piece.b, piece.uvA, piece.uvB);
  }
  return halves;
}

// Second halves that wait for the first ones to be finished; the pieces of a triangle of 180 degrees are
// 2^-12 of that at this depth.
const int kMostWaiting = 24;

// A piece may be drawn with straight edges where all of them stay within half a texel, which is 1 / side.
GNOMON_FN bool isDrawnStraight(int side, int slice, Piece piece) {
  return worstBend(pieceBends(side, slice, piece, true)) <= 1.0f / float(side);
}

// Whether none of a piece is drawn.
GNOMON_FN bool isBeyondRim(int side, int slice, Piece piece) {
  float rimW = piecesRimW(side, true);
  float axis = paraboloidAxisZ(slice);
  return piece.a.z * axis < rimW * length(piece.a) && piece.b.z * axis < rimW * length(piece.b) &&
         piece.c.z * axis < rimW * length(piece.c);
}

// What must be wasted before a piece is cut in two: texels, and a share of the bound, since halves have more rim than
// the whole, and the rasterizer shades it in blocks. Swept on lavapipe (processor time of two layers of 1774 x 1774
// texels, medians of 9 interleaved rounds, against no cuts), at 256, 1024 and 4096 texels: a level of one mesh 0.83,
// 0.83, 0.80; a furnished court 0.83, 0.78, 0.79; a scene of small casters 0.97, 0.98, 1.02; instances of dense solids
// 0.98, 0.93, 0.95. So it is the cutting that pays, hardly where it ends.
const float kWastedTexels = 1024.0f;
const float kWastedShare = 0.5f;

GNOMON_FN float quadArea(vec2 p0, vec2 p1, vec2 p2, vec2 p3) {
  vec2 d = p2 - p0;
  vec2 e = p3 - p1;
  return 0.5f * abs(d.x * e.y - d.y * e.x);
}

// Whether a piece's bound encloses much more than the piece.
GNOMON_FN bool isWasteful(int side, int slice, Piece piece, QuadBound bound) {
  float enclosed = quadArea(bound.p0, bound.p1, bound.p2, bound.p3);
  float wasted = enclosed;
  vec3 a = sliceFromLight(slice, piece.a);
  vec3 b = sliceFromLight(slice, piece.b);
  vec3 c = sliceFromLight(slice, piece.c);
  float la = length(a);
  float lb = length(b);
  float lc = length(c);
  if (la == 0.0f || lb == 0.0f || lc == 0.0f) return false;
  if (a.z >= 0.0f && b.z >= 0.0f && c.z >= 0.0f) {
    vec2 pa = vec2(a.x, a.y) * (1.0f / (la + a.z));
    wasted -= quadArea(pa, vec2(b.x, b.y) * (1.0f / (lb + b.z)), vec2(c.x, c.y) * (1.0f / (lc + c.z)), pa);
  }
  return wasted >= kWastedShare * enclosed && wasted * 0.25f * float(side) * float(side) >= kWastedTexels;
}

// Whether two bounds of a piece's halves would enclose much less than the piece's own.
GNOMON_FN bool isWorthHalving(int side, int slice, Piece piece, QuadBound bound) {
  if (!isWasteful(side, slice, piece, bound)) return false;
  vec3 a = sliceFromLight(slice, piece.a);
  vec3 b = sliceFromLight(slice, piece.b);
  vec3 c = sliceFromLight(slice, piece.c);
  Bends bends = pieceBends(side, slice, piece, false);
  float worst = worstBend(bends);
  // A quarter of a texel's bend is nothing to gain by.
  if (worst * float(side) < 0.5f) return false;
  // The middle of an edge that passes nearer to the light than a 32nd of its ends is rounded by more
  // than the bound's margin.
  vec3 p = bends.a == worst ? b : (bends.b == worst ? c : a);
  vec3 q = bends.a == worst ? c : (bends.b == worst ? a : b);
  return length(arcMiddle(p, q)) * 64.0f > length(p) + length(q);
}

GNOMON_SHARED_END
#endif
