// The number of a pixel's triangle (shared/triangle_ids.glsl), where the bias reads ids. To be included after
// scene/surface_fetch.glsl.
#ifndef GNOMON_RECEIVER_ID_GLSL
#define GNOMON_RECEIVER_ID_GLSL

#include "shadow/fetch_channels.glsl"

uint receiverId(PrimitiveId id) {
  if ((kChannels & (kChannelIds | kChannelSecondIds)) == 0) return 0u;
  if (kInstanced == 0) return id.triangle + 1u;
  uint instance = id.instancePlusOne - 1u;
  return instances[instance].firstId + (id.triangle - instances[instance].firstTriangle);
}

#endif
