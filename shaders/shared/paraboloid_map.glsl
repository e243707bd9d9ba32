// Dual paraboloid maps: two layers, each a hemisphere around a point light, depth linear in the
// distance from the light.
// Heidrich, Seidel, "View-independent environment maps", 1998; Brabec, Annen, Seidel, "Shadow Mapping for Hemispherical
// and Omnidirectional Light Sources", 2002. Part of shared/map.glsl, which includes it after the structs.
//
//     slice 0 looks along -z of L, slice 1 along +z; on both, with d the unit direction and w = |d.z|
//
//       (x, y) = (d.x, d.y) / (1 + w)        u = (1 + x)/2, v = (1 - y)/2
//
//         +-----------+   w > 0 is the disc x^2 + y^2 < 1. This is the stereographic projection from the opposite
//         |  .-----.  |   pole: circles on the sphere stay circles, so a triangle's straight edge, a great circle,
//         | /       \ |   becomes a circular arc, and angles are kept. Its inverse needs no root:
//         | |   +   | |
//         | \       / |   d = (2 x, 2 y, 1 - x^2 - y^2) / (1 + x^2 + y^2)     (third component along the slice's axis)
//         |  '-----'  |
//         +-----------+   Beyond the rim the same formula goes on over the other hemisphere.
//
// A texel that the disc touches is drawn, with its own centre's ray, be it beyond the rim; the rest of
// the square stays empty.
//
// Differs from Dou et al. 2014, which has R = (x, y, (1 - x^2 - y^2)/2): that vector's length is (1 + x^2 +
// y^2)/2, and R must be unit.
#ifndef GNOMON_PARABOLOID_MAP_GLSL
#define GNOMON_PARABOLOID_MAP_GLSL

#include "shared/geometry.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// The sign of z of the slice's axis.
GNOMON_FN float paraboloidAxisZ(int slice) { return slice == 0 ? -1.0f : 1.0f; }

GNOMON_FN MapPoint paraboloidProject(vec3 posL) {
  float radius = length(posL);
  float scale = 1.0f / (radius + abs(posL.z));
  MapPoint point;
  point.slice = posL.z <= 0.0f ? 0 : 1;
  point.uv = vec2(posL.x * scale * 0.5f + 0.5f, 0.5f - posL.y * scale * 0.5f);
  point.covered = radius > 0.0f;  // but the light's own place
  return point;
}

GNOMON_FN Ray paraboloidTexelRay(ShadowMap map, int slice, vec2 uv) {
  float x = uv.x * 2.0f - 1.0f;
  float y = 1.0f - uv.y * 2.0f;
  float square = x * x + y * y;
  float scale = 1.0f / (1.0f + square);
  Ray ray;
  ray.dir = vec3(2.0f * x * scale, 2.0f * y * scale, paraboloidAxisZ(slice) * (1.0f - square) * scale);
  ray.origin = ray.dir * map.zNear;
  return ray;
}

// side, 1 / side, zNear, zFar - zNear
GNOMON_FN vec4 paraboloidDrawnNumbers(ShadowMap map) {
  float side = float(map.width);
  return vec4(side, 1.0f / side, map.zNear, map.zFar - map.zNear);
}

// The same ray where a texel is drawn, by its centre in texels. Not unit but of size 1 + x^2 + y^2, so that it meets a
// plane with n.p = 1 at size / (n.dir) metres from the light: no root, and one division.
struct ParaboloidDrawnRay {
  vec3 dir;
  float size;
};

GNOMON_FN ParaboloidDrawnRay paraboloidDrawnRay(vec4 numbers, int slice, vec2 center) {
  float x = (2.0f * center.x - numbers.x) * numbers.y;
  float y = (numbers.x - 2.0f * center.y) * numbers.y;
  float square = x * x + y * y;
  ParaboloidDrawnRay ray;
  ray.dir = vec3(2.0f * x, 2.0f * y, paraboloidAxisZ(slice) * (1.0f - square));
  ray.size = 1.0f + square;
  return ray;
}

// `along`: metres from the light.
GNOMON_FN float paraboloidDrawnDepth(vec4 numbers, float along) { return (along - numbers.z) / numbers.w; }

GNOMON_FN float paraboloidDepth(ShadowMap map, vec3 posL) {
  return (length(posL) - map.zNear) / (map.zFar - map.zNear);
}

GNOMON_FN float paraboloidDepthSlope(ShadowMap map) { return 1.0f / (map.zFar - map.zNear); }

GNOMON_FN float paraboloidDistance(ShadowMap map, float depth) { return depth * (map.zFar - map.zNear); }

// Whether the disc touches the texel around `center` (texels): the nearest point of its square lies within the rim. A
// millionth is in hand for the rounding of paraboloidProject, so that every point it covers lies on a texel that is
// drawn. Lengths in half texels from the slice's centre, without rounding.
GNOMON_FN bool paraboloidHoldsTexelAt(float side, vec2 center) {
  float x = max(abs(2.0f * center.x - side) - 1.0f, 0.0f);
  float y = max(abs(2.0f * center.y - side) - 1.0f, 0.0f);
  return x * x + y * y <= side * side * 1.000001f;
}

GNOMON_SHARED_END
#endif
