// Bevy's defaults (bevyengine/bevy, crates/bevy_pbr: render/shadows.wgsl and light.rs, 0.15):
//
//   looked up at   P + N n sqrt(2) t + L m    t: width of a texel; L: unit, towards the light
//   point light                 n = 0.6 texels, m = 0.08 m
//   spot and directional light  n = 1.8 texels, m = 0.02 m
//
// Differs: the engine measures t on the axis of a cube's face, here it is measured on the ray.
#ifndef GNOMON_BIAS_BEVY_GLSL
#define GNOMON_BIAS_BEVY_GLSL

#include "shared/bias/moved_lookup.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

GNOMON_FN Receiver bevyReceiver(ShadowMap map, Receiver receiver) {
  MapPoint point = mapProject(map, receiver.posL);
  if (!point.covered) return receiver;
  Ray ray = mapTexelRay(map, point.slice, point.uv);
  float texels = looksAround(map) ? 0.6f : 1.8f;
  float metres = looksAround(map) ? 0.08f : 0.02f;
  float offset = texels * 1.41421356f * texelWidthAt(map, point, ray, receiver.posL);
  return movedWithin(map, receiver, receiver.posL + receiver.normalL * offset - ray.dir * metres);
}

GNOMON_SHARED_END
#endif
