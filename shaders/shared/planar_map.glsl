// Spot and directional maps, and every warp and cascade of them: one general projective matrix a slice.
// Part of shared/map.glsl, which includes it after the structs. Akenine-Moeller, Haines, Hoffman, "Real-Time
// Rendering", 3rd edition, section 9.1.4.
#ifndef GNOMON_PLANAR_MAP_GLSL
#define GNOMON_PLANAR_MAP_GLSL

#include "shared/geometry.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// Cascades: the first layer that covers the point, finest first.
GNOMON_FN MapPoint planarProject(ShadowMap map, vec3 posL) {
  MapPoint point;
  point.slice = 0;
  point.uv = vec2(0.0f, 0.0f);
  point.covered = false;
  for (int slice = 0; slice < map.sliceCount && !point.covered; ++slice) {
    vec4 clip = transform(GNOMON_MEMBER_ARRAY(map, mapSlices)[slice].clipFromLight, vec4(posL, 1.0f));
    if (clip.w > 0.0f) {
      vec2 uv = vec2(clip.x / clip.w * 0.5f + 0.5f, clip.y / clip.w * 0.5f + 0.5f);
      point.slice = slice;
      point.uv = uv;
      point.covered = uv.x >= 0.0f && uv.x <= 1.0f && uv.y >= 0.0f && uv.y <= 1.0f;
    }
  }
  return point;
}

// Unprojects depths 0 and 1, which lie in front of the light on every ray of every warp (src/planar/planar_map.cpp sees
// to it). Where the light is a point, both ends lie on a line through it, and the rounding of the
// far end's w only moves that end along the line, so the direction is good to a few ulps.
GNOMON_FN Ray planarTexelRay(ShadowMap map, int slice, vec2 uv) {
  vec4 clip = vec4(uv.x * 2.0f - 1.0f, uv.y * 2.0f - 1.0f, 0.0f, 1.0f);
  vec4 nearH = transform(GNOMON_MEMBER_ARRAY(map, mapSlices)[slice].lightFromClip, clip);
  clip.z = 1.0f;
  vec4 farH = transform(GNOMON_MEMBER_ARRAY(map, mapSlices)[slice].lightFromClip, clip);
  vec3 nearL = vec3(nearH) * (1.0f / nearH.w);
  vec3 farL = vec3(farH) * (1.0f / farH.w);
  Ray ray;
  ray.origin = nearL;
  ray.dir = unitVector(farL - nearL);
  return ray;
}

GNOMON_FN float planarDepth(ShadowMap map, int slice, vec3 posL) {
  vec4 clip = transform(GNOMON_MEMBER_ARRAY(map, mapSlices)[slice].clipFromLight, vec4(posL, 1.0f));
  return clip.z / clip.w;
}

// (z/w)' = (z' w - z w') / w^2
GNOMON_FN float planarDepthSlope(ShadowMap map, int slice, vec3 posL, vec3 rayDir) {
  vec4 clip = transform(GNOMON_MEMBER_ARRAY(map, mapSlices)[slice].clipFromLight, vec4(posL, 1.0f));
  vec4 rate = transform(GNOMON_MEMBER_ARRAY(map, mapSlices)[slice].clipFromLight, vec4(rayDir, 0.0f));
  return (rate.z * clip.w - clip.z * rate.w) / (clip.w * clip.w);
}

// (z + t z') / (w + t w') = depth, solved for t
GNOMON_FN float planarDistance(ShadowMap map, int slice, Ray ray, float depth) {
  vec4 clip = transform(GNOMON_MEMBER_ARRAY(map, mapSlices)[slice].clipFromLight, vec4(ray.origin, 1.0f));
  vec4 rate = transform(GNOMON_MEMBER_ARRAY(map, mapSlices)[slice].clipFromLight, vec4(ray.dir, 0.0f));
  return (depth * clip.w - clip.z) / (rate.z - depth * rate.w);
}

GNOMON_SHARED_END
#endif
