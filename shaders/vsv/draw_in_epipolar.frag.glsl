// shadow/draw_bounded_triangle.frag.glsl for a shadow volume's columns alone, with the same bits but without a load.
// (Sines and cosines from a table, two fetches a fragment, took longer than the four of them.)
#include "shared/map.glsl"

#include "shadow/bounded_fragment.glsl"
#include "shadow/bounded_hole.glsl"
#include "shadow/store_channels.glsl"

layout(constant_id = 0) const int kMasked = 0;

void main() {
  vec4 theta = drawnNumbers();
  vec4 phi = moreNumbers;
  vec3 dir = epipolarMapDrawnRay(theta, phi, gl_FragCoord.xy);
  vec3 distances = sideDistances(boundedTriangle(), dir);
  float along = distanceAlong(dir, 1.0f);
  DrawnFragment drawn = boundedFragment(epipolarMapDrawnDepth(theta, phi, dir * along));
  if (!isWithin(distances) || !isAhead(along)) discard;
  if (kMasked == 1 && isHoleAt(distances)) discard;
  gl_FragDepth = drawn.depth;
  storeChannels(drawn);
}
