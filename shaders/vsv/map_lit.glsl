// Shadow-map lookup for a point in the medium. Without bias, because there is no surface that could shadow itself.
#ifndef GNOMON_MAP_LIT_GLSL
#define GNOMON_MAP_LIT_GLSL

#include "shared/map.glsl"
#include "shared/shade.glsl"

layout(binding = kBindMapDepth) uniform texture2DArray mapDepthSlices;

// A texel in which nothing was drawn shadows nothing, and what no slice covers is lit.
bool isMapLit(ShadowMap map, vec3 posL) {
  MapPoint point = mapProject(map, posL);
  if (!point.covered) return true;
  float stored = texelFetch(mapDepthSlices, ivec3(mapTexel(map, point.uv), point.slice), 0).x;
  return stored >= 1.0f || mapDepth(map, point.slice, posL) < stored;
}

#endif
