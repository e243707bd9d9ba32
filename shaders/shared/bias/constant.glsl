// Constant bias, in metres: the receiver is moved towards the light along the texel's direction before the comparison.
// Williams 1978; Reeves, Salesin, Cook, "Rendering Antialiased Shadows with Depth Maps", 1987.
#ifndef GNOMON_BIAS_CONSTANT_GLSL
#define GNOMON_BIAS_CONSTANT_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// The depth of a point `offset` metres nearer the light. A point that would pass the near end stays there.
GNOMON_FN float depthTowardsLight(ShadowMap map, int layer, vec3 posL, Ray ray, float offset) {
  float room = dot(posL - ray.origin, ray.dir);
  return mapDepth(map, layer, posL - ray.dir * min(offset, max(room, 0.0f)));
}

GNOMON_FN bool constantLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  return depthTowardsLight(map, tap.layer, receiver.posL, tap.ray, params.constantOffset) <= tap.z1;
}

GNOMON_SHARED_END
#endif
