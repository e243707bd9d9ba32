#include "plane_case.h"

namespace gnomon::test {

using namespace glsl;

PlaneCase planeCase(const ShadowMap& map, const MapSample& sample, float tanAngle, float azimuth) {
  PlaneCase result;
  const Ray toPoint = mapTexelRay(map, sample.slice, sample.uv);
  result.receiver = {sample.posL, facingNormal(toPoint.dir, tanAngle, azimuth)};
  // Not always the sample's own slice: of cascades the finest that holds the point is looked up.
  const MapPoint point = mapProject(map, sample.posL);
  const ivec2 texel = mapTexel(map, point.uv);
  Tap& tap = result.tap;
  tap = emptyTap(point.slice, texel, mapTexelRay(map, point.slice, mapTexelCenter(map, texel)));
  const PlaneDepth plane = receiverPlaneDepth(map, tap.slice, result.receiver, tap.ray);
  result.meets = !plane.grazing;
  tap.z1 = plane.depth;
  return result;
}

}  // namespace gnomon::test
