// The receiver that a surface point is, in the light's frame. The including shader declares `shade`.
#ifndef GNOMON_RECEIVER_GLSL
#define GNOMON_RECEIVER_GLSL

#include "shared/bias.glsl"

// False where the surface faces away from the light.
bool receiverOf(SurfacePoint surface, out Receiver receiver) {
  float lightSide = dot(surface.normal, towardsLight(shade, surface.position));
  float cameraSide = dot(surface.normal, shade.camera.eyeW - surface.position);
  receiver.posL = lightFromWorld(lightFrame, surface.position);
  receiver.normalL = directionFromWorld(lightFrame, lightSide > 0.0f ? surface.normal : -surface.normal);
  receiver.id = 0u;
  return lightSide * cameraSide > 0.0f;
}

#endif
