// Placeholder for a user's own bias: `gnomon compare SCENE --bias-file my.glsl` compiles that file instead of this one.
// samples/my_bias.glsl is an example, docs/add_a_bias.md says what a file may declare.
#ifndef GNOMON_BIAS_USER_GLSL
#define GNOMON_BIAS_USER_GLSL

#include "shared/bias/constant.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// Whether the texel lights the receiver. What stands here is no bias at all, moved by the knob (metres)
// as an example of its use.
GNOMON_FN bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  return litWithOffset(map, receiver, tap, params.knobs[kUserOffset]);
}

GNOMON_SHARED_END
#endif
