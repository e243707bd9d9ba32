// A pixel's receiver: its surface point in the light's frame, or the reason why it has none. The including shader
// declares `shade` and the G-buffer (scene/surface_fetch.glsl).
#ifndef GNOMON_RECEIVER_FETCH_GLSL
#define GNOMON_RECEIVER_FETCH_GLSL

// False where the surface faces away from the light.
bool fetchReceiver(ivec2 pixel, PrimitiveId id, out Receiver receiver) {
  SurfacePoint surface = fetchSurface(shade.camera, pixel, id);
  float lightSide = dot(surface.normal, towardsLight(shade, surface.position));
  float cameraSide = dot(surface.normal, shade.camera.eyeW - surface.position);
  receiver.posL = lightFromWorld(lightFrame, surface.position);
  receiver.normalL = directionFromWorld(lightFrame, lightSide > 0.0f ? surface.normal : -surface.normal);
  receiver.id = 0u;
  return lightSide * cameraSide > 0.0f;
}

#endif
