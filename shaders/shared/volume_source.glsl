// The nearest occluder of a column of a shadow volume, as an alpha, from a map of the same light. There are two kinds
// of source: the columns' own map, rasterized with one ray-triangle test a column, and any other map, in which the
// column's ray is looked up. In the latter the column is occluded from where the map's depth along the ray equals the
// stored depth: exactly that map's shadow test, without bias, for every point of the column.
#ifndef GNOMON_VOLUME_SOURCE_GLSL
#define GNOMON_VOLUME_SOURCE_GLSL

#include "shared/epipolar.glsl"
#include "shared/lang.glsl"
#include "shared/light_frame.glsl"
#include "shared/map.glsl"

GNOMON_SHARED_BEGIN

GNOMON_FN float noOccluder() { return uintBitsToFloat(0x7f800000u); }

// A column's direction in the frame of another map.
GNOMON_FN vec3 sourceDirection(LightFrame volumeFrame, LightFrame sourceFrame, vec3 dirL) {
  vec3 dirW = volumeFrame.rightW * dirL.x + volumeFrame.upW * dirL.y + volumeFrame.backW * dirL.z;
  return directionFromWorld(sourceFrame, dirW);
}

// `depth`: what the texel at `point` stores, which is mapProject of dirS, the column's direction
// dirL in the map's frame.
GNOMON_FN float alphaLookedUp(ShadowMap source, MapPoint point, float depth, vec3 dirS, vec3 dirL, float eyeDistance) {
  if (!point.covered || depth >= 1.0f) return noOccluder();
  Ray ray = mapTexelRay(source, point.slice, point.uv);
  float along = mapDistance(source, point.slice, ray, depth) + dot(ray.origin, dirS);
  return epipolarFromLight(eyeDistance, dirL * along).alpha;
}

// `depth`: what the columns' own map stores.
GNOMON_FN float alphaDrawn(EpipolarGrid grid, float depth) {
  return depth < 1.0f ? depth * alphaUpper(grid) : noOccluder();
}

GNOMON_SHARED_END
#endif
