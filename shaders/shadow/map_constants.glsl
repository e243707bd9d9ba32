// What a visibility pipeline is specialized to, beside the method and the map's kind.
#ifndef GNOMON_MAP_CONSTANTS_GLSL
#define GNOMON_MAP_CONSTANTS_GLSL

#include "shared/filter.glsl"

layout(constant_id = 3) const int kSliceCount = 1;
layout(constant_id = 6) const int kFilter = kShadowFilterNone;  // kShadowFilter*
layout(constant_id = 7) const int kTapCount = 1;

#endif
