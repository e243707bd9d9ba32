// Cube maps: six faces of 90 degrees around a point light, in the slice order and orientation of Vulkan's cube maps.
// L has the world's axes. Part of shared/map.glsl, which includes it after the structs.
//
//     slice   0   1   2   3   4   5       a face is seen from the light; clip space is (s, t, depth, m):
//     face   +X  -X  +Y  -Y  +Z  -Z       u = (s/m + 1)/2, v = (t/m + 1)/2, m = metres along the face's axis
//       s    -z  +z  +x  +x  +x  -x
//       t    -y  -y  +z  -z  -y  -y       "Vulkan 1.3", section 16.5.4, table "Cube map face and coordinate selection".
//       m    +x  -x  +y  -y  +z  -z       Read from outside: the faces mirror what a camera would see.
//
// Choosing signs and components rounds nothing, so that (s, t, m) are the very bits that the slice's clipFromLight,
// whose entries but those of depth are 0 and +-1, gives the rasterizer; and no matrix is fetched by a slice that
// differs from pixel to pixel.
#ifndef GNOMON_CUBE_MAP_GLSL
#define GNOMON_CUBE_MAP_GLSL

#include "shared/geometry.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// A face's axis (0 x, 1 y, 2 z) and the table's signs; factors of +-1 round nothing. Without a branch: lavapipe goes
// through all of a switch, a component at a time.
struct CubeFaceSigns {
  int axis;
  float s;
  float t;
  float m;
};

GNOMON_FN CubeFaceSigns cubeFaceSigns(int slice) {
  CubeFaceSigns signs;
  signs.axis = slice >> 1;
  signs.m = (slice & 1) == 1 ? -1.0f : 1.0f;
  signs.s = signs.axis == 0 ? -signs.m : signs.axis == 1 ? 1.0f : signs.m;
  signs.t = signs.axis == 1 ? signs.m : -1.0f;
  return signs;
}

// A point in a face's own coordinates: s, t, m.
GNOMON_FN vec3 cubeFaceFromLight(int slice, vec3 posL) {
  CubeFaceSigns signs = cubeFaceSigns(slice);
  float s = signs.axis == 0 ? posL.z : posL.x;
  float t = signs.axis == 1 ? posL.z : posL.y;
  float m = signs.axis == 0 ? posL.x : signs.axis == 1 ? posL.y : posL.z;
  return vec3(signs.s * s, signs.t * t, signs.m * m);
}

GNOMON_FN vec3 cubeLightFromFace(int slice, vec3 stm) {
  CubeFaceSigns signs = cubeFaceSigns(slice);
  float s = signs.s * stm.x;
  float t = signs.t * stm.y;
  float m = signs.m * stm.z;
  return vec3(signs.axis == 0 ? m : s, signs.axis == 1 ? m : t, signs.axis == 0 ? s : signs.axis == 1 ? t : m);
}

// The face of the largest coordinate; where two are equal, x before y before z.
GNOMON_FN int cubeFace(vec3 posL) {
  float x = abs(posL.x);
  float y = abs(posL.y);
  float z = abs(posL.z);
  bool onX = x >= y && x >= z;
  bool onY = !onX && y >= z;
  float m = onX ? posL.x : onY ? posL.y : posL.z;
  return (onX ? 0 : onY ? 2 : 4) + (m >= 0.0f ? 0 : 1);
}

GNOMON_FN MapPoint cubeProject(vec3 posL) {
  MapPoint point;
  point.slice = cubeFace(posL);
  vec3 stm = cubeFaceFromLight(point.slice, posL);
  point.covered = stm.z > 0.0f;  // but the light's own place
  point.uv = vec2(stm.x / stm.z * 0.5f + 0.5f, stm.y / stm.z * 0.5f + 0.5f);
  return point;
}

// uv beyond the face's edge continue its plane.
GNOMON_FN Ray cubeTexelRay(ShadowMap map, int slice, vec2 uv) {
  vec3 acrossL = cubeLightFromFace(slice, vec3(uv.x * 2.0f - 1.0f, uv.y * 2.0f - 1.0f, 1.0f));
  Ray ray;
  ray.dir = unitVector(acrossL);
  ray.origin = mapKind(map) == kMapCubeRadial ? ray.dir * map.zNear : acrossL * map.zNear;
  return ray;
}

GNOMON_FN float cubeDepth(ShadowMap map, int slice, vec3 posL) {
  if (mapKind(map) == kMapCubeRadial) return (length(posL) - map.zNear) / (map.zFar - map.zNear);
  float m = cubeFaceFromLight(slice, posL).z;
  return (map.clipDepth.x * m + map.clipDepth.y) / m;
}

// Hyperbolic: (x + y / m)' = -y m' / m^2, equation 10 of Dou et al. 2014 where the ray is the face's axis.
GNOMON_FN float cubeDepthSlope(ShadowMap map, int slice, vec3 posL, vec3 rayDir) {
  if (mapKind(map) == kMapCubeRadial) return 1.0f / (map.zFar - map.zNear);
  float m = cubeFaceFromLight(slice, posL).z;
  float rate = cubeFaceFromLight(slice, rayDir).z;
  return -map.clipDepth.y * rate / (m * m);
}

GNOMON_FN float cubeDistance(ShadowMap map, int slice, Ray ray, float depth) {
  if (mapKind(map) == kMapCubeRadial) return depth * (map.zFar - map.zNear);
  float m = map.clipDepth.y / (depth - map.clipDepth.x);
  return (m - cubeFaceFromLight(slice, ray.origin).z) / cubeFaceFromLight(slice, ray.dir).z;
}

GNOMON_SHARED_END
#endif
