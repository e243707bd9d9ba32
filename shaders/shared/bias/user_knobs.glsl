// Indices of a user-defined bias's parameters, as in params.knobs[kUserOffset]. With --bias-file this file is replaced
// by one generated from the `//! knob:` lines.
#ifndef GNOMON_BIAS_USER_KNOBS_GLSL
#define GNOMON_BIAS_USER_KNOBS_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kUserOffset = 0;

GNOMON_SHARED_END
#endif
