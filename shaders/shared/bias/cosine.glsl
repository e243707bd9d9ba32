// Cosine bias: a constant weighted by the angle between the surface and the light.
// Gautron, Marvie, Briand, "Method for Generating Shadows in an Image", EP 2411967, 2013: none where the surface faces
// the light, the whole offset where it is edge-on.
#ifndef GNOMON_BIAS_COSINE_GLSL
#define GNOMON_BIAS_COSINE_GLSL

#include "shared/bias/constant.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kCosineOffset = 0;  // metres

GNOMON_FN bool cosineLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  float facing = clamp(-dot(receiver.normalL, tap.ray.dir), 0.0f, 1.0f);
  return litWithOffset(map, receiver, tap, params.knobs[kCosineOffset] * (1.0f - facing));
}

GNOMON_SHARED_END
#endif
