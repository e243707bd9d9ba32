// shadow/draw_bounded_triangle.frag.glsl for paraboloid maps alone: the same decisions and depths up to rounding, in
// half as many operations, since the ray need not be unit (paraboloidDrawnRay), and without a load.
#include "shared/map.glsl"

#include "shadow/bounded_fragment.glsl"
#include "shadow/bounded_hole.glsl"
#include "shadow/store_channels.glsl"

layout(constant_id = 0) const int kMasked = 0;

void main() {
  vec4 ofMap = drawnNumbers();
  ParaboloidDrawnRay ray = paraboloidDrawnRay(ofMap, slice, gl_FragCoord.xy);
  vec3 distances = sideDistances(boundedTriangle(), ray.dir);
  float along = distanceAlong(ray.dir, ray.size);
  DrawnFragment drawn = boundedFragment(paraboloidDrawnDepth(ofMap, along));
  if (!isWithin(distances) || !isAhead(along) || !paraboloidHoldsTexelAt(ofMap.x, gl_FragCoord.xy)) discard;
  if (kMasked == 1 && isHoleAt(distances)) discard;
  gl_FragDepth = drawn.depth;
  storeChannels(drawn);
}
