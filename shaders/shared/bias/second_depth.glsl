// Second depth: the map stores the back faces of solids (and sheets as they are), which no lit surface is near.
// Wang, Molnar, "Second-Depth Shadow Mapping", TR94-019, University of North Carolina, 1994.
#ifndef GNOMON_BIAS_SECOND_DEPTH_GLSL
#define GNOMON_BIAS_SECOND_DEPTH_GLSL

#include "shared/bias/constant.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kSecondDepthOffset = 0;  // metres

// Sheets need an offset still.
GNOMON_FN bool secondDepthLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  return litBehind(map, receiver, tap, tap.zBack, params.knobs[kSecondDepthOffset]);
}

GNOMON_SHARED_END
#endif
