// Rays from the light against triangles in L: which rays meet a triangle, and where.
//
// A ray along d meets (a, b, c) where d lies on the inner side of the three planes through the light and an edge. A plane's normal is
// a x b = (a + b) x (b - a) / 2. The right form loses no digits where the edge is short, and changes its sign and nothing else when a
// and b are exchanged: two triangles that share an edge get opposite bits of the very same number, so that no ray slips between them.
// Davidovic, Engelhardt, Georgiev, Slusallek, Dachsbacher, "3D Rasterization: A Bridge between Rasterization and Ray Casting",
// Graphics Interface 2012, section 3; the difference form as in Embree's robust mode.
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

// Metres along the ray to the triangle in such a direction. First a mean of its corners, which rounding moves within the plane and not
// off it; but in a slender triangle far within it, so the rest of the way to the ray is gone along the plane. There the normal of a
// slender triangle, which is as uncertain, counts only for that rest; and never farther than the triangle is long.
GNOMON_FN float distanceAlong(LightTriangle triangle, vec3 dir, vec3 distances) {
  float scale = 1.0f / (distances.x + distances.y + distances.z);
  vec3 mean = (triangle.a * distances.x + triangle.b * distances.y + triangle.c * distances.z) * scale;
  float along = dot(mean, dir);
  vec3 ab = triangle.b - triangle.a;
  vec3 ac = triangle.c - triangle.a;
  vec3 normal = cross(ab, ac);
  float approach = dot(normal, dir);
  if (approach == 0.0f) return along;
  float most = length(ab) + length(ac);
  return along + clamp(dot(normal, mean - dir * along) / approach, -most, most);
}

GNOMON_SHARED_END
#endif
