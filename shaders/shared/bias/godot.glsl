// Godot's defaults (godotengine/godot, renderer_rd: LightStorage::update_light_buffers for what the settings become,
// light_process_omni_shadow and light_process_spot_shadow of scene_forward_lights_inc.glsl, BIAS_FUNC of
// scene_forward_clustered.glsl; 4.x). d: the unit ray from the light to P, r: its length, s: the map's texels across.
//
//   point light         looked up along  d + N 10 / s (1 - |N.d|)     shadow_normal_bias 1, times 10 / s
//                       stored depth     + 0.1 m                      shadow_bias 0.1
//   spot light          looked up at     P + N 10 r / s (1 - |N.d|)
//                       stored depth     + r c / (r + c)            shadow_bias 0.03, c = 0.0003 (range / near - 1)
//   directional light   looked up at     P + t (N - (N.d) d)          t: width of a texel
//                       stored depth     + 0.001 m                    shadow_bias 0.1, a hundredth of it
//
// A spot light's c is what the engine adds to its clip depth, 0.0003 range / r, in metres: near is 0.025 m, or the
// range where that is less. The range is where the map ends, since lights here need not have one.
//
// Differs: a point light is two paraboloids there, of which s texels lie across each; here any map. The engine's
// filtering is left out, and what it scales with the filter (a spot light's c) and with the cascade.
#ifndef GNOMON_BIAS_GODOT_GLSL
#define GNOMON_BIAS_GODOT_GLSL

#include "shared/bias/constant.glsl"
#include "shared/bias/moved_lookup.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

// Whether all rays of the slice are parallel: of a spot light they part by its cone.
GNOMON_FN bool hasParallelRays(ShadowMap map, int slice) {
  if (looksAround(map)) return false;
  vec3 across = mapTexelRay(map, slice, vec2(1.0f, 1.0f)).dir - mapTexelRay(map, slice, vec2(0.0f, 0.0f)).dir;
  return dot(across, across) < 1e-10f;  // 1e-5 radians: a hundred times what rounding leaves
}

GNOMON_FN Receiver godotReceiver(ShadowMap map, Receiver receiver) {
  MapPoint point = mapProject(map, receiver.posL);
  if (!point.covered) return receiver;
  if (hasParallelRays(map, point.slice)) {
    Ray ray = mapTexelRay(map, point.slice, point.uv);
    vec3 across = receiver.normalL - ray.dir * dot(receiver.normalL, ray.dir);
    float texel = texelWidthAt(map, point, ray, receiver.posL);
    return movedWithin(map, receiver, receiver.posL + across * texel);
  }
  float reach = length(receiver.posL);
  float grazing = 1.0f - abs(dot(receiver.normalL, receiver.posL)) / reach;
  vec3 moved = receiver.posL + receiver.normalL * (10.0f / float(map.width) * reach * grazing);
  if (looksAround(map)) moved = unitVector(moved) * reach;
  return movedWithin(map, receiver, moved);
}

// Metres along the ray of length `reach` by which the stored depth is moved away.
GNOMON_FN float godotOffset(ShadowMap map, int slice, float reach) {
  if (looksAround(map)) return 0.1f;
  if (hasParallelRays(map, slice)) return 0.001f;
  Ray axis = mapTexelRay(map, slice, vec2(0.5f, 0.5f));
  float range = length(axis.origin) + mapDistance(map, slice, axis, 1.0f);
  float c = 0.0003f * (range / min(range, 0.025f) - 1.0f);
  return reach * c / (reach + c);
}

GNOMON_FN bool godotLit(ShadowMap map, Receiver receiver, Tap tap) {
  return litWithOffset(map, receiver, tap, godotOffset(map, tap.slice, length(receiver.posL)));
}

GNOMON_SHARED_END
#endif
