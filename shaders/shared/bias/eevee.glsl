// What Blender's EEVEE does by itself (blender/blender: shadow_normal_offset of eevee_shadow_tracing_lib, and the slope
// bias of the shadow surface shader; as of 2025):
//
//   looked up at   P + N r (sin a / cos 0.534 + 0.195)    r: half the diagonal of a texel; a: between N and the light
//   stored depth   + |dz/du| + |dz/dv|, over a texel
//
// Differs: the engine adds the slope of the caster as it draws it. Here it is that of the receiver's plane, the same
// wherever a surface would shadow itself. Its jittered rays and its clipmaps are left out.
#ifndef GNOMON_BIAS_EEVEE_GLSL
#define GNOMON_BIAS_EEVEE_GLSL

#include "shared/bias/moved_lookup.glsl"
#include "shared/bias/slope.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const float kEeveeQuantizedNormal = 1.1617397f;  // 1 / cos(0.534 radians), which covers a quantized normal
const float kEeveeNeighbours = 0.195f;          // for adjacent polygons

GNOMON_FN Receiver eeveeReceiver(ShadowMap map, Receiver receiver) {
  MapPoint point = mapProject(map, receiver.posL);
  if (!point.covered) return receiver;
  Ray ray = mapTexelRay(map, point.slice, point.uv);
  float radius = 0.70710678f * texelWidthAt(map, point, ray, receiver.posL);
  float facing = clamp(-dot(receiver.normalL, ray.dir), 0.0f, 1.0f);
  float sine = sqrt(max(1.0f - facing * facing, 0.0f));
  float offset = radius * (sine * kEeveeQuantizedNormal + kEeveeNeighbours);
  return movedWithin(map, receiver, receiver.posL + receiver.normalL * offset);
}

GNOMON_FN bool eeveeLit(ShadowMap map, Receiver receiver, Tap tap) {
  float center = receiverPlaneDepth(map, tap.slice, receiver, tap.ray).depth;
  vec2 uv = mapTexelCenter(map, tap.texel);
  vec2 halfTexel = vec2(0.5f / float(map.width), 0.5f / float(map.height));
  float change = planeDepthChange(map, tap.slice, receiver, center, vec2(uv.x + halfTexel.x, uv.y)) +
                 planeDepthChange(map, tap.slice, receiver, center, vec2(uv.x, uv.y + halfTexel.y));
  return mapDepth(map, tap.slice, receiver.posL) - 2.0f * change <= tap.z1;
}

GNOMON_SHARED_END
#endif
