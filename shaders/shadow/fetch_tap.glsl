// What one texel of a map says. The including shader has the functions of shadow/fetch_channels.glsl.
#ifndef GNOMON_FETCH_TAP_GLSL
#define GNOMON_FETCH_TAP_GLSL

#include "shared/channels.glsl"
#include "shared/map.glsl"

#include "shadow/fetch_channels.glsl"

Tap fetchTap(ShadowMap map, int slice, ivec2 texel) {
  Tap tap = emptyTap(slice, texel, mapTexelRay(map, slice, mapTexelCenter(map, texel)));
  if ((kChannels & kChannelDepth) != 0) tap.z1 = fetchDepth(slice, texel);
  if ((kChannels & kChannelSecondDepth) != 0) tap.z2 = fetchSecondDepth(slice, texel);
  if ((kChannels & kChannelBackDepth) != 0) tap.zBack = fetchBackDepth(slice, texel);
  if ((kChannels & kChannelIds) != 0) tap.id1 = fetchId(slice, texel);
  if ((kChannels & kChannelSecondIds) != 0) tap.id2 = fetchSecondId(slice, texel);
  return tap;
}

#endif
