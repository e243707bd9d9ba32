// How a fragment stores what the channels of its texel hold (shared/channels.glsl): the last that each fragment shader
// of a map does. What a fragment has to offer is its depth and which triangle of which instance it is of.
//
// A colour's location is that of its channel in src/shadow/channel.cpp. kStored says which the pass has a target for.
// Depth itself is the depth buffer's: gl_FragCoord.z, unless the shader writes gl_FragDepth.
#ifndef GNOMON_STORE_CHANNELS_GLSL
#define GNOMON_STORE_CHANNELS_GLSL

#include "shared/channels.glsl"

#include "shadow/drawn_fragment.glsl"
#include "shadow/drawn_slice.glsl"

layout(constant_id = 1) const int kPass = kPassNearest;
layout(constant_id = 4) const int kStored = 0;  // kChannel* bits

layout(binding = kBindMapDepth) uniform texture2DArray depthSlices;

layout(location = 0) out float storedSecondDepth;
layout(location = 1) out uint storedId;
layout(location = 2) out uint storedSecondId;

// In the peel what equals the first depth layer, up to a tolerance, is thrown away (Weiskopf & Ertl 2003, section 5).
void storeChannels(DrawnFragment drawn) {
  if (kPass == kPassPeel) {
    float first = texelFetch(depthSlices, ivec3(ivec2(gl_FragCoord.xy), drawnSlice()), 0).x;
    if (drawn.depth <= first + tolerance) discard;
  }
  if ((kStored & kChannelSecondDepth) != 0) storedSecondDepth = drawn.depth;
  if ((kStored & kChannelIds) != 0) storedId = drawn.id;
  if ((kStored & kChannelSecondIds) != 0) storedSecondId = drawn.id;
}

#endif
