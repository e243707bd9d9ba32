// Constant bias, in metres: the stored surface is moved away from the light along the texel's ray.
// Williams 1978; Reeves, Salesin, Cook, "Rendering Antialiased Shadows with Depth Maps", 1987.
#ifndef GNOMON_BIAS_CONSTANT_GLSL
#define GNOMON_BIAS_CONSTANT_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kConstantOffset = 0;  // metres

// Lit where the receiver, at its depth on the texel's ray, lies at most `offset` metres behind what the texel stores.
GNOMON_FN bool litBehind(ShadowMap map, Receiver receiver, Tap tap, float stored, float offset) {
  float depth = mapDepth(map, tap.slice, receiver.posL);
  float distance_ = mapDistance(map, tap.slice, tap.ray, depth);
  return distance_ <= mapDistance(map, tap.slice, tap.ray, stored) + offset;
}

// Behind the nearest depth.
GNOMON_FN bool litWithOffset(ShadowMap map, Receiver receiver, Tap tap, float offset) {
  return litBehind(map, receiver, tap, tap.z1, offset);
}

// The depth of a point `offset` metres nearer the light. A point that would pass the near end stays there.
GNOMON_FN float depthTowardsLight(ShadowMap map, int slice, vec3 posL, Ray ray, float offset) {
  float room = dot(posL - ray.origin, ray.dir);
  return mapDepth(map, slice, posL - ray.dir * min(offset, max(room, 0.0f)));
}

GNOMON_FN bool constantLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  return litWithOffset(map, receiver, tap, params.knobs[kConstantOffset]);
}

GNOMON_SHARED_END
#endif
