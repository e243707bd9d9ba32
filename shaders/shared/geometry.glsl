// Rays, planes, and the point of a triangle that a pixel sees.
#ifndef GNOMON_GEOMETRY_GLSL
#define GNOMON_GEOMETRY_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// Matrix times vector and unit length by plain sums and products in a fixed order: the built-in ones differ between
// compilers by an ulp or more, and a receiver must land on the very texel its caster was drawn to.
GNOMON_FN vec4 transform(mat4 m, vec4 v) { return ((m[0] * v.x + m[1] * v.y) + m[2] * v.z) + m[3] * v.w; }

GNOMON_FN vec3 unitVector(vec3 v) { return v * (1.0f / sqrt(v.x * v.x + v.y * v.y + v.z * v.z)); }

struct Ray {
  vec3 origin;
  vec3 dir;  // unit
};

// Metres along the ray to the plane through `point` with unit `normal`; negative behind the origin.
// A ray that runs in the plane's direction never meets it: -1.
GNOMON_FN float rayPlaneDistance(Ray ray, vec3 point, vec3 normal) {
  float approach = dot(normal, ray.dir);
  if (approach == 0.0f) return -1.0f;
  return dot(normal, point - ray.origin) / approach;
}

// What a pixel sees of a triangle: a point that lies on it, and its plane.
struct SurfacePoint {
  vec3 position;
  vec3 normal;       // unit, by the winding: counter-clockwise seen from the front
  vec3 barycentric;  // weights of the three corners, within [0,1]
};

// The weights come from the ray (Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997), but
// the position is their sum over the corners: an error of the weights moves the point within the plane and not off it,
// and off the plane is what a shadow test would notice. The rasterizer decides which pixels a triangle covers on a grid
// of 1/256 pixel, so the ray may pass just outside: weights are clamped to the triangle.
GNOMON_FN SurfacePoint surfacePoint(Ray ray, vec3 a, vec3 b, vec3 c) {
  vec3 ab = b - a;
  vec3 ac = c - a;
  vec3 scaledNormal = cross(ab, ac);
  vec3 toOrigin = ray.origin - a;
  vec3 q = cross(toOrigin, ray.dir);
  float determinant = -dot(scaledNormal, ray.dir);
  float scale = determinant == 0.0f ? 0.0f : 1.0f / determinant;
  float v = clamp(dot(ac, q) * scale, 0.0f, 1.0f);
  float w = clamp(-dot(ab, q) * scale, 0.0f, 1.0f - v);
  SurfacePoint point;
  point.barycentric = vec3(1.0f - v - w, v, w);
  point.position = a * point.barycentric.x + b * v + c * w;
  float area = length(scaledNormal);
  point.normal = area > 0.0f ? scaledNormal * (1.0f / area) : vec3(0.0f, 0.0f, 0.0f);
  return point;
}

GNOMON_SHARED_END
#endif
