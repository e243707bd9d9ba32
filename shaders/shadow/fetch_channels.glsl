// Where what the channels of a texel hold (shared/channels.glsl) is fetched from.
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

float fetchDepth(int slice, ivec2 texel) { return texelFetch(depthSlices, ivec3(texel, slice), 0).x; }
float fetchSecondDepth(int slice, ivec2 texel) {
  return texelFetch(secondDepthSlices, ivec3(texel, slice), 0).x;
}
float fetchBackDepth(int slice, ivec2 texel) {
  return texelFetch(backDepthSlices, ivec3(texel, slice), 0).x;
}
uint fetchId(int slice, ivec2 texel) { return texelFetch(idSlices, ivec3(texel, slice), 0).x; }
uint fetchSecondId(int slice, ivec2 texel) {
  return texelFetch(secondIdSlices, ivec3(texel, slice), 0).x;
}

#endif
