// A pixel's receiver, by its G-buffer triangle. The including shader declares `shade` and the G-buffer
// (scene/surface_fetch.glsl).
#ifndef GNOMON_RECEIVER_FETCH_GLSL
#define GNOMON_RECEIVER_FETCH_GLSL

#include "shadow/receiver.glsl"

// False where the surface faces away from the light.
bool fetchReceiver(ivec2 pixel, PrimitiveId id, out Receiver receiver) {
  return receiverOf(fetchSurface(shade.camera, pixel, id), receiver);
}

#endif
