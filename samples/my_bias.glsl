// A user-defined bias, to be scored beside the built-in ones:
//
//   gnomon compare atrium --maps spot --bias-file samples/my_bias.glsl --tune
//
// The idea: the adaptive bias of Dou et al. is exact on planes and fails at creases and on curved meshes, where the
// texel saw another plane than the receiver's. Its error there grows with the distance between the texel's ray and the
// receiver, so this one allows the plane's depth to be off by a share of that distance.
//
//! name: leaning-plane
//! sentence: The receiver's plane at the texel's ray, off by a share of the distance between ray and receiver.
//! knob: share one 0 4 0.5
#ifndef MY_BIAS_GLSL
#define MY_BIAS_GLSL

#include "shared/bias.glsl"

GNOMON_SHARED_BEGIN

// `tap.ray` passes through the centre of the texel that is looked up, `tap.z1` is what the texel stores. Everything is
// in the light's frame, in metres; depths are the map's, and mapDistance turns one into metres along a ray.
GNOMON_FN bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  PlaneDepth plane = receiverPlaneDepth(map, tap.slice, receiver, tap.ray);
  float along = dot(receiver.posL - tap.ray.origin, tap.ray.dir);
  vec3 nearest = tap.ray.origin + tap.ray.dir * along;
  float aside = length(receiver.posL - nearest);  // metres
  float stored = mapDistance(map, tap.slice, tap.ray, tap.z1);
  float wanted = mapDistance(map, tap.slice, tap.ray, plane.depth);
  return wanted <= stored + params.knobs[kUserShare] * aside + 1e-4f * map.sceneScale;
}

GNOMON_SHARED_END
#endif
