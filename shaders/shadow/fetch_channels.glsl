// How a tap fetches what the channels of its texel hold (shared/channels.glsl).
#ifndef GNOMON_FETCH_CHANNELS_GLSL
#define GNOMON_FETCH_CHANNELS_GLSL

#include "shared/channels.glsl"
#include "shared/map.glsl"

layout(constant_id = 5) const int kChannels = kChannelDepth;  // what the bias reads

layout(binding = kBindMapDepth) uniform texture2DArray depthSlices;
layout(binding = kBindSecondDepth) uniform texture2DArray secondDepthSlices;
layout(binding = kBindBackDepth) uniform texture2DArray backDepthSlices;
layout(binding = kBindIds) uniform usampler2DArray idSlices;
layout(binding = kBindSecondIds) uniform utexture2DArray secondIdSlices;

Tap fetchTap(ShadowMap map, int slice, ivec2 texel) {
  Tap tap = emptyTap(slice, texel, mapTexelRay(map, slice, mapTexelCenter(map, texel)));
  ivec3 at = ivec3(texel, slice);
  if ((kChannels & kChannelDepth) != 0) tap.z1 = texelFetch(depthSlices, at, 0).x;
  if ((kChannels & kChannelSecondDepth) != 0) tap.z2 = texelFetch(secondDepthSlices, at, 0).x;
  if ((kChannels & kChannelBackDepth) != 0) tap.zBack = texelFetch(backDepthSlices, at, 0).x;
  if ((kChannels & kChannelIds) != 0) tap.id1 = texelFetch(idSlices, at, 0).x;
  if ((kChannels & kChannelSecondIds) != 0) tap.id2 = texelFetch(secondIdSlices, at, 0).x;
  return tap;
}

#endif
