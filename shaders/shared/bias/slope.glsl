// Slope-scale bias: King, "Shadow Mapping Algorithms", 2004; the polygon offset of the graphics APIs.
//
// bias = factor * (depth change of the receiver's plane across half a texel) + offset,
// the change being the larger of those in u and v, as in the APIs' rule max(|dz/dx|, |dz/dy|). Distances are taken on
// the rays, in metres, so that the same factor means the same on every map and for every depth encoding.
#ifndef GNOMON_BIAS_SLOPE_GLSL
#define GNOMON_BIAS_SLOPE_GLSL

#include "shared/bias/constant.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// Metres by which the receiver's plane recedes along the ray through uv against the ray through the texel's centre.
// A plane that the ray does not meet (grazing) recedes without bound: the scene's scale stands in.
GNOMON_FN float planeRecession(ShadowMap map, int layer, Receiver receiver, float centerDistance, vec2 uv) {
  Ray ray = mapTexelRay(map, layer, uv);
  float t = rayPlaneDistance(ray, receiver.posL, receiver.normalL);
  if (t < 0.0f) return map.sceneScale;
  return min(abs(t - centerDistance), map.sceneScale);
}

GNOMON_FN bool slopeLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  float center = rayPlaneDistance(tap.ray, receiver.posL, receiver.normalL);
  vec2 uv = mapTexelCenter(map, tap.texel);
  float half_ = 0.5f / float(map.side);
  float change = max(planeRecession(map, tap.layer, receiver, center, vec2(uv.x + half_, uv.y)),
                     planeRecession(map, tap.layer, receiver, center, vec2(uv.x, uv.y + half_)));
  float offset = params.slopeFactor * change + params.slopeOffset;
  return depthTowardsLight(map, tap.layer, receiver.posL, tap.ray, offset) <= tap.z1;
}

GNOMON_SHARED_END
#endif
