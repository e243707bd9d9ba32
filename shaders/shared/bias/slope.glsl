// Slope-scale bias: King, "Shadow Mapping Algorithms", 2004; the polygon offset of the graphics APIs.
//
// bias = factor * max(|dd/du|, |dd/dv|) * half a texel, in the map's depth, and an offset in metres,
// where d(u, v) is the depth of the receiver's plane: the rule of the graphics APIs. In a planar map d is affine in
// (u, v), so that a factor of 2 covers every point of the texel: half a texel in u and half a texel in v.
#ifndef GNOMON_BIAS_SLOPE_GLSL
#define GNOMON_BIAS_SLOPE_GLSL

#include "shared/bias/constant.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kSlopeFactor = 0;
const int kSlopeOffset = 1;  // metres

// By how much the receiver's plane changes depth from the texel's centre to uv. A plane that the ray through uv does
// not meet (grazing) changes by the whole range.
GNOMON_FN float planeDepthChange(ShadowMap map, int slice, Receiver receiver, float centerDepth, vec2 uv) {
  Ray ray = mapTexelRay(map, slice, uv);
  float t = rayPlaneDistance(ray, receiver.posL, receiver.normalL);
  if (t < 0.0f) return 1.0f;
  return min(abs(mapDepth(map, slice, ray.origin + ray.dir * t) - centerDepth), 1.0f);
}

GNOMON_FN bool slopeLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  float center = receiverPlaneDepth(map, tap.slice, receiver, tap.ray).depth;
  vec2 uv = mapTexelCenter(map, tap.texel);
  vec2 halfTexel = vec2(0.5f / float(map.width), 0.5f / float(map.height));
  float change = max(planeDepthChange(map, tap.slice, receiver, center, vec2(uv.x + halfTexel.x, uv.y)),
                     planeDepthChange(map, tap.slice, receiver, center, vec2(uv.x, uv.y + halfTexel.y)));
  float depth = depthTowardsLight(map, tap.slice, receiver.posL, tap.ray, params.knobs[kSlopeOffset]);
  return depth - params.knobs[kSlopeFactor] * change <= tap.z1;
}

GNOMON_SHARED_END
#endif
