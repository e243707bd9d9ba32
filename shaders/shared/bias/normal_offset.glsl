// Normal offset: the receiver is moved along its normal, by texels of the map at its distance, times the sine of the
// angle between normal and light, and then looked up and compared as it is.
// Holbert, "Saying Goodbye to Shadow Acne", GDC 2011.
#ifndef GNOMON_BIAS_NORMAL_OFFSET_GLSL
#define GNOMON_BIAS_NORMAL_OFFSET_GLSL

#include "shared/bias/none.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kNormalOffsetTexels = 0;

// Where the receiver is looked up. One that is, or would come to lie, outside the map stays where it is.
GNOMON_FN Receiver normalOffsetReceiver(ShadowMap map, BiasParams params, Receiver receiver) {
  MapPoint point = mapProject(map, receiver.posL);
  if (!point.covered) return receiver;
  Ray ray = mapTexelRay(map, point.slice, point.uv);
  Ray next = mapTexelRay(map, point.slice, vec2(point.uv.x + 1.0f / float(map.width), point.uv.y));
  float along = dot(receiver.posL - ray.origin, ray.dir);
  vec3 across = (next.origin + next.dir * along) - (ray.origin + ray.dir * along);
  float texel = length(across);  // metres
  float facing = clamp(-dot(receiver.normalL, ray.dir), 0.0f, 1.0f);
  float sine = sqrt(max(1.0f - facing * facing, 0.0f));
  Receiver moved = receiver;
  moved.posL = receiver.posL + receiver.normalL * (params.knobs[kNormalOffsetTexels] * texel * sine);
  if (!mapProject(map, moved.posL).covered) return receiver;
  return moved;
}

GNOMON_SHARED_END
#endif
