// Normal offset: the receiver is moved along its normal, by texels of the map at its distance, times the sine of the
// angle between normal and light, and then looked up and compared as it is.
// Holbert, "Saying Goodbye to Shadow Acne", GDC 2011.
#ifndef GNOMON_BIAS_NORMAL_OFFSET_GLSL
#define GNOMON_BIAS_NORMAL_OFFSET_GLSL

#include "shared/bias/moved_lookup.glsl"
#include "shared/bias/none.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kNormalOffsetTexels = 0;

// Where the receiver is looked up. One that is, or would come to lie, outside the map stays where it is.
GNOMON_FN Receiver normalOffsetReceiver(ShadowMap map, BiasParams params, Receiver receiver) {
  MapPoint point = mapProject(map, receiver.posL);
  if (!point.covered) return receiver;
  Ray ray = mapTexelRay(map, point.slice, point.uv);
  float texel = texelWidthAt(map, point, ray, receiver.posL);
  float facing = clamp(-dot(receiver.normalL, ray.dir), 0.0f, 1.0f);
  float sine = sqrt(max(1.0f - facing * facing, 0.0f));
  return movedWithin(map, receiver,
                     receiver.posL + receiver.normalL * (params.knobs[kNormalOffsetTexels] * texel * sine));
}

GNOMON_SHARED_END
#endif
