// Rays from the light against triangles in L: which rays meet a triangle, and where.
//
// A ray along d meets (a, b, c) where d lies on the inner side of the three planes through the light and an edge. A
// plane's normal is a x b = (a + b) x (b - a) / 2. The right form loses no digits where the edge is short, and changes
// its sign and nothing else when a and b are exchanged: two triangles that share an edge get opposite bits of the very
// same number, so that no ray slips between them.
// Davidovic, Engelhardt, Georgiev, Slusallek, Dachsbacher, "3D Rasterization: A Bridge between Rasterization and Ray
// Casting", Graphics Interface 2012, section 3; the difference form as in Embree's robust mode.
#ifndef GNOMON_RAY_TRIANGLE_GLSL
#define GNOMON_RAY_TRIANGLE_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

struct LightTriangle {
  vec3 a, b, c;           // L
  vec3 sideA, sideB, sideC;  // normals of the planes opposite a, b, c, inwards; any length
  // Six times the volume of the tetrahedron with the light: negative where the triangle winds counter-clockwise
  // seen from the light.
  float volume;
};

GNOMON_FN vec3 edgePlane(vec3 from, vec3 to) {
  GNOMON_PRECISE vec3 sum = from + to;
  GNOMON_PRECISE vec3 along = to - from;
  GNOMON_PRECISE vec3 normal =
      vec3(sum.y * along.z - sum.z * along.y, sum.z * along.x - sum.x * along.z, sum.x * along.y - sum.y * along.x);
  return normal;
}

GNOMON_FN LightTriangle lightTriangle(vec3 a, vec3 b, vec3 c) {
  LightTriangle triangle;
  triangle.a = a;
  triangle.b = b;
  triangle.c = c;
  triangle.volume = dot(a, cross(b - a, c - a));
  float inwards = triangle.volume < 0.0f ? -1.0f : 1.0f;
  triangle.sideA = edgePlane(b, c) * inwards;
  triangle.sideB = edgePlane(c, a) * inwards;
  triangle.sideC = edgePlane(a, b) * inwards;
  return triangle;
}

// How far inside each side's plane a direction lies, which are also the weights of the corners, up to a common factor.
GNOMON_FN vec3 sideDistances(LightTriangle triangle, vec3 dir) {
  GNOMON_PRECISE float a = dir.x * triangle.sideA.x + dir.y * triangle.sideA.y + dir.z * triangle.sideA.z;
  GNOMON_PRECISE float b = dir.x * triangle.sideB.x + dir.y * triangle.sideB.y + dir.z * triangle.sideB.z;
  GNOMON_PRECISE float c = dir.x * triangle.sideC.x + dir.y * triangle.sideC.y + dir.z * triangle.sideC.z;
  return vec3(a, b, c);
}

// A direction exactly on an edge belongs to both sides of it.
GNOMON_FN bool isWithin(vec3 distances) {
  return distances.x >= 0.0f && distances.y >= 0.0f && distances.z >= 0.0f &&
         distances.x + distances.y + distances.z > 0.0f;
}

// The triangle's plane as n with n.p = 1 on it, so that a ray along d meets it at 1/(n.d) metres: one product
// and one division a texel.
//
// An error of n moves the meeting by itself times the way from a corner. The cross product of two float edges is off by
// 2^-24 times the triangle's slenderness (longest edge squared over twice the area), and a slender triangle is long; so
// it is taken of the unrounded edges, to twice the digits. Dekker, "A floating-point technique for extending the
// available precision", 1971; Knuth, TAOCP 2, 4.2.2.
struct Twofold {
  vec3 high, low;  // their unrounded sum is meant
};

GNOMON_FN Twofold twofoldDifference(vec3 a, vec3 b) {
  GNOMON_PRECISE vec3 high = a - b;
  GNOMON_PRECISE vec3 back = high - a;
  GNOMON_PRECISE vec3 low = (a - (high - back)) - (b + back);
  Twofold difference;
  difference.high = high;
  difference.low = low;
  return difference;
}

// Component by component; 4097 = 2^12 + 1 splits a float's 24 bits in halves whose products are exact.
GNOMON_FN Twofold twofoldProduct(Twofold a, Twofold b) {
  GNOMON_PRECISE vec3 ta = a.high * 4097.0f;
  GNOMON_PRECISE vec3 a1 = ta - (ta - a.high);
  GNOMON_PRECISE vec3 a2 = a.high - a1;
  GNOMON_PRECISE vec3 tb = b.high * 4097.0f;
  GNOMON_PRECISE vec3 b1 = tb - (tb - b.high);
  GNOMON_PRECISE vec3 b2 = b.high - b1;
  GNOMON_PRECISE vec3 high = a.high * b.high;
  GNOMON_PRECISE vec3 low = ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2;
  GNOMON_PRECISE vec3 all = low + (a.high * b.low + a.low * b.high);
  Twofold product;
  product.high = high;
  product.low = all;
  return product;
}

GNOMON_FN Twofold turned(Twofold v) {
  Twofold t;
  t.high = vec3(v.high.y, v.high.z, v.high.x);
  t.low = vec3(v.low.y, v.low.z, v.low.x);
  return t;
}

// (b - a) x (c - a), as exact as floats can hold it.
GNOMON_FN vec3 exactNormal(vec3 a, vec3 b, vec3 c) {
  Twofold ab = twofoldDifference(b, a);
  Twofold ac = twofoldDifference(c, a);
  Twofold plus = twofoldProduct(turned(ab), turned(turned(ac)));
  Twofold minus = twofoldProduct(turned(turned(ab)), turned(ac));
  Twofold normal = twofoldDifference(plus.high, minus.high);
  GNOMON_PRECISE vec3 rounded = normal.high + (normal.low + (plus.low - minus.low));
  return rounded;
}

GNOMON_FN vec3 inversePlaneNormal(LightTriangle triangle) {
  vec3 normal = exactNormal(triangle.a, triangle.b, triangle.c);
  return normal * (1.0f / dot(normal, triangle.a));
}

GNOMON_SHARED_END
#endif
