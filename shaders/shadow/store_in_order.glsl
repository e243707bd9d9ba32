// Takes the place of store_channels.glsl where fragments see, in the order of the triangles, what the texel holds
// (SecondLayer::Ordered): one pass keeps the two nearest depths, and which triangles they are of. Each pair is one
// image: lavapipe takes as long to read one component of a colour as two (of one layer's time two images took 2.5, one
// 1.7).
//
// The bits are those of the two passes. A depth that equals the first is not the second, and of fragments with equal
// depths the first one drawn stays: no later one takes its place, and it is passed over only where two nearer ones are
// there already, which stay nearer.
#ifndef GNOMON_STORE_IN_ORDER_GLSL
#define GNOMON_STORE_IN_ORDER_GLSL

#include "shared/channels.glsl"

#include "shadow/drawn_fragment.glsl"
#include "shadow/drawn_slice.glsl"

layout(constant_id = 4) const int kStored = 0;  // kChannel* bits

layout(input_attachment_index = 0, binding = kBindMapDepth) uniform subpassInput depthsBefore;
layout(input_attachment_index = 1, binding = kBindIds) uniform usubpassInput idsBefore;

layout(location = 0) out vec2 storedDepths;
layout(location = 1) out uvec2 storedIds;

void storeChannels(DrawnFragment drawn) {
  float z = clamp(drawn.depth, 0.0f, 1.0f);  // as the depth test of the other passes has it
  vec2 before = subpassLoad(depthsBefore).xy;
  float z1 = before.x;
  float z2 = before.y;
  storedDepths = vec2(min(z, z1), z == z1 ? z2 : min(z2, max(z, z1)));
  if ((kStored & (kChannelIds | kChannelSecondIds)) != 0) {
    uvec2 ids = subpassLoad(idsBefore).xy;
    storedIds = z < z1 ? uvec2(drawn.id, ids.x) : uvec2(ids.x, z > z1 && z < z2 ? drawn.id : ids.y);
  }
}

#endif
