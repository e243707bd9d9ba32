#include "plane_case.h"

namespace gnomon::test {

using namespace glsl;

PlaneCase planeCase(const ShadowMap& map, const MapSample& sample, float tanAngle, float azimuth) {
  PlaneCase result;
  const Ray toPoint = mapTexelRay(map, sample.layer, sample.uv);
  result.receiver = {sample.posL, facingNormal(toPoint.dir, tanAngle, azimuth)};
  // Not always the sample's own layer: of cascades the finest that holds the point is looked up.
  const MapPoint point = mapProject(map, sample.posL);
  Tap& tap = result.tap;
  tap.layer = point.layer;
  tap.texel = mapTexel(map, point.uv);
  tap.ray = mapTexelRay(map, tap.layer, mapTexelCenter(map, tap.texel));
  const PlaneDepth plane = receiverPlaneDepth(map, tap.layer, result.receiver, tap.ray);
  result.meets = !plane.grazing;
  tap.z1 = plane.depth;
  tap.z2 = 1.0f;
  return result;
}

}  // namespace gnomon::test
