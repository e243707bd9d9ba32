//! name: constant-in-depth
//! sentence: A constant of the map's own depth, which a perspective map compresses: little near the light, much far from it.
//! knob: offset one 0 1 0.0001
#ifndef CONSTANT_IN_DEPTH_GLSL
#define CONSTANT_IN_DEPTH_GLSL

#include "shared/bias.glsl"

GNOMON_SHARED_BEGIN

GNOMON_FN bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  return mapDepth(map, tap.slice, receiver.posL) - params.knobs[kUserOffset] <= tap.z1;
}

GNOMON_SHARED_END
#endif
