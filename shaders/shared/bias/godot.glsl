// Godot's defaults (godotengine/godot, renderer_rd, scene_forward_lights_inc.glsl and the light storage, 4.0):
//
//   looked up at   P + N t (1 - cos a)    t: width of a texel (shadow_normal_bias 1); a: between N and the light
//   stored depth   + 0.01 range           shadow_bias 0.1 times range / 10
//
// A point light turns the direction of the look-up only: its depth stays that of P. Of a spot light t is the width at
// the range's end.
//
// Differs: the range is where the map ends, since lights here need not have one. A directional light has a cascade's
// extent for it in the engine. Filtering is left out.
#ifndef GNOMON_BIAS_GODOT_GLSL
#define GNOMON_BIAS_GODOT_GLSL

#include "shared/bias/constant.glsl"
#include "shared/bias/moved_lookup.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

GNOMON_FN Receiver godotReceiver(ShadowMap map, Receiver receiver) {
  MapPoint point = mapProject(map, receiver.posL);
  if (!point.covered) return receiver;
  Ray ray = mapTexelRay(map, point.slice, point.uv);
  vec3 widthAtL = looksAround(map) ? receiver.posL : ray.origin + ray.dir * mapDistance(map, point.slice, ray, 1.0f);
  float texel = texelWidthAt(map, point, ray, widthAtL);
  vec3 moved = receiver.posL + receiver.normalL * (texel * (1.0f - abs(dot(receiver.normalL, ray.dir))));
  if (looksAround(map)) moved = unitVector(moved) * length(receiver.posL);
  return movedWithin(map, receiver, moved);
}

GNOMON_FN bool godotLit(ShadowMap map, Receiver receiver, Tap tap) {
  return litWithOffset(map, receiver, tap, 0.01f * mapDistance(map, tap.slice, tap.ray, 1.0f));
}

GNOMON_SHARED_END
#endif
