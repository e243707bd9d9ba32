// The nearest occluder of a column of a shadow volume, as alpha, from what a map of the same light stores. Two kinds of map: the columns'
// own, where each column's ray has met the scene itself, and any other, in which the ray is looked up. There a column is hidden from where the
// map's depth along the ray is what the texel stores: the very answer of that map, without bias, for every point of the column.
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

// `depth`: what the texel at `point` stores, which is mapProject of dirS, the column's direction dirL in the map's frame.
GNOMON_FN float alphaLookedUp(ShadowMap source, MapPoint point, float depth, vec3 dirS, vec3 dirL, float eyeDistance) {
  if (!point.covered || depth >= 1.0f) return noOccluder();
  Ray ray = mapTexelRay(source, point.layer, point.uv);
  float along = mapDistance(source, point.layer, ray, depth) + dot(ray.origin, dirS);
  return epipolarFromLight(eyeDistance, dirL * along).alpha;
}

// `depth`: what the columns' own map stores.
GNOMON_FN float alphaDrawn(EpipolarGrid grid, float depth) { return depth < 1.0f ? depth * alphaUpper(grid) : noOccluder(); }

GNOMON_SHARED_END
#endif
