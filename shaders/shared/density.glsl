// A density grid in the world, and the table of how much of it lies between a light and a point.
#ifndef GNOMON_DENSITY_GLSL
#define GNOMON_DENSITY_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// The grid's own index space, in which voxels have their values at whole numbers. Affine; both centres are the same
// point, so that what is far from the world's origin keeps its digits.
struct DensityPlace {
  vec3 centerW;
  vec3 centerI;
  mat3 indexFromWorld;  // of differences
  vec3 lowerI;          // outside there is nothing
  vec3 upperI;
};

GNOMON_FN vec3 indexDirection(DensityPlace place, vec3 dirW) {
  return place.indexFromWorld[0] * dirW.x + place.indexFromWorld[1] * dirW.y + place.indexFromWorld[2] * dirW.z;
}

GNOMON_FN vec3 indexFromWorld(DensityPlace place, vec3 posW) {
  return place.centerI + indexDirection(place, posW - place.centerW);
}

// A direction that runs along a slab leaves it, but not before 1e30 voxels: 0 / 0 would say nothing.
GNOMON_FN float notZero(float x) { return x == 0.0f ? 1e-30f : x; }

// Where a ray is within the grid's bounds: x to y metres, none where x >= y. Kay and Kajiya, "Ray tracing
// complex scenes", 1986: slabs.
GNOMON_FN vec2 rayWithinBounds(DensityPlace place, vec3 originW, vec3 dirW, float end) {
  vec3 origin = indexFromWorld(place, originW);
  vec3 dir = indexDirection(place, dirW);
  dir = vec3(notZero(dir.x), notZero(dir.y), notZero(dir.z));
  vec3 toLower = (place.lowerI - origin) / dir;
  vec3 toUpper = (place.upperI - origin) / dir;
  vec3 enter = min(toLower, toUpper);
  vec3 leave = max(toLower, toUpper);
  return vec2(max(max(max(enter.x, enter.y), enter.z), 0.0f), min(min(min(leave.x, leave.y), leave.z), end));
}

// Directions and distances from a light that a density's bounds take up. Directions are those of one or two hemispheres
// about an axis, as in a paraboloid map: (x, y) / (1 + |z|), which spreads them evenly to within a factor of 2. One
// hemisphere cut to the cone of the bounds where the light is outside, both where it is within.
struct LightReach {
  vec3 axisW;       // unit
  float halfWidth;  // of the slices, in units of (x, y) / (1 + |z|)
  int layers;       // 1 or 2
  float near_;      // metres, of the first radius
  float far_;       // of the last
  int substeps;     // samples from one radius to the next
};

// Duff, Burgess, Christensen, Hery, Kensler, Liani, Villemin, "Building an Orthonormal Basis,
// Revisited", JCGT 6(1), 2017.
GNOMON_FN mat3 basisAbout(vec3 axis) {
  float s = axis.z >= 0.0f ? 1.0f : -1.0f;
  float a = -1.0f / (s + axis.z);
  float b = axis.x * axis.y * a;
  mat3 basis;
  basis[0] = vec3(1.0f + s * axis.x * axis.x * a, s * b, -s * axis.x);
  basis[1] = vec3(b, s + axis.y * axis.y * a, -axis.y);
  basis[2] = axis;
  return basis;
}

struct LightDirection {
  int slice;
  vec2 uv;  // [0, 1]^2
};

GNOMON_FN LightDirection lightDirection(LightReach reach, vec3 dirW) {
  mat3 basis = basisAbout(reach.axisW);
  float z = dot(dirW, basis[2]);
  float scale = 0.5f / ((1.0f + abs(z)) * reach.halfWidth);
  LightDirection direction;
  direction.slice = reach.layers == 2 && z < 0.0f ? 1 : 0;
  direction.uv = vec2(dot(dirW, basis[0]) * scale + 0.5f, dot(dirW, basis[1]) * scale + 0.5f);
  return direction;
}

// The inverse; beyond a hemisphere's rim its formula goes on below it.
GNOMON_FN vec3 directionFromLight(LightReach reach, int slice, vec2 uv) {
  mat3 basis = basisAbout(reach.axisW);
  float x = (2.0f * uv.x - 1.0f) * reach.halfWidth;
  float y = (2.0f * uv.y - 1.0f) * reach.halfWidth;
  float square = x * x + y * y;
  float z = (1.0f - square) / (1.0f + square);
  float across = 2.0f / (1.0f + square);
  return basis[0] * (x * across) + basis[1] * (y * across) + basis[2] * (slice == 1 ? -z : z);
}

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::DensityPlace) == 84);
static_assert(sizeof(gnomon::glsl::LightReach) == 32);
#endif
#endif
