// Midpoint and dual-layer bias: the shadowing surface is moved away from the nearest layer, towards the second one.
//   midpoint  (z2 - z1) / 2               Woo, "The Shadow Depth Map Revisited", Graphics Gems III, 1992
//   dual      min((z2 - z1) / 2, offset)  Weiskopf, Ertl, "Shadow Mapping Based on Dual Depth Layers", 2003, equation 2
//
// Differs from the paper: z1, z2 and the receiver are compared as metres along the texel's ray, and not as the map
// encodes them, so that the offset is a length and the midpoint the same on every map. z2 is the far end where
// there is no second layer.
#ifndef GNOMON_BIAS_DUAL_LAYER_GLSL
#define GNOMON_BIAS_DUAL_LAYER_GLSL

#include "shared/bias/constant.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kDualOffset = 0;  // metres; midpoint has no knob

GNOMON_FN float halfLayerGap(ShadowMap map, Tap tap) {
  float first = mapDistance(map, tap.slice, tap.ray, tap.z1);
  return 0.5f * (mapDistance(map, tap.slice, tap.ray, tap.z2) - first);
}

GNOMON_FN bool midpointLit(ShadowMap map, Receiver receiver, Tap tap) {
  return litWithOffset(map, receiver, tap, halfLayerGap(map, tap));
}

GNOMON_FN bool dualLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  return litWithOffset(map, receiver, tap, min(halfLayerGap(map, tap), params.knobs[kDualOffset]));
}

GNOMON_SHARED_END
#endif
