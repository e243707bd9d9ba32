// The non-linear rasterizer: one ray-triangle test a texel. It uses only mapTexelRay, mapHoldsTexelAt and mapDepth of
// the parameterization; a compute shader has bounded the triangle's projection before.
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_MAP_KIND kMapKind

#include "shared/map.glsl"

#include "shadow/bounded_fragment.glsl"
#include "shadow/bounded_hole.glsl"
#include "shadow/store_channels.glsl"

layout(constant_id = 0) const int kMasked = 0;

void main() {
  ShadowMap map = shadowMap;
  // mapTexelCenter, which the rasterizer counts for us.
  Ray ray = mapTexelRay(map, slice, gl_FragCoord.xy / mapTexelCounts(map));
  vec3 distances = sideDistances(boundedTriangle(), ray.dir);
  float along = distanceAlong(ray.dir, 1.0f);
  DrawnFragment drawn = boundedFragment(mapDepth(map, slice, ray.dir * along));
  if (!isWithin(distances) || !isAhead(along) || !mapHoldsTexelAt(map, gl_FragCoord.xy)) discard;
  if (kMasked == 1 && isHoleAt(distances)) discard;
  gl_FragDepth = drawn.depth;
  storeChannels(drawn);
}
