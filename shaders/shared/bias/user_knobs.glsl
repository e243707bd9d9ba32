// Where the knobs of a user's own bias are found: params.knobs[kUserOffset]. With --bias-file a text that is made of the
// file's `//! knob:` lines stands here.
#ifndef GNOMON_BIAS_USER_KNOBS_GLSL
#define GNOMON_BIAS_USER_KNOBS_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kUserOffset = 0;

GNOMON_SHARED_END
#endif
