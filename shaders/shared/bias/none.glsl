// No bias: Williams, "Casting Curved Shadows on Curved Surfaces", 1978, as first drawn, with all its acne.
#ifndef GNOMON_BIAS_NONE_GLSL
#define GNOMON_BIAS_NONE_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

GNOMON_FN bool noneLit(ShadowMap map, Receiver receiver, Tap tap) {
  return mapDepth(map, tap.slice, receiver.posL) <= tap.z1;
}

GNOMON_SHARED_END
#endif
