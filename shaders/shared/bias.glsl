// A bias decides whether a receiver is lit, from the receiver's plane, the texel's ray and the texel's channels
// (shared/channels.glsl). It does not know which parameterization it runs on.
//
// To add one: a file in bias/, an id in bias_params.glsl, a case here, a row in src/shadow/bias.cpp
// (docs/add_a_bias.md).
#ifndef GNOMON_BIAS_GLSL
#define GNOMON_BIAS_GLSL

#include "shared/bias_params.glsl"
#include "shared/channels.glsl"
#include "shared/geometry.glsl"
#include "shared/lang.glsl"
#include "shared/map.glsl"

GNOMON_SHARED_BEGIN

// What is shaded: a point and the unit geometric normal of its surface, turned to the light's side.
struct Receiver {
  vec3 posL;
  vec3 normalL;
  uint id GNOMON_CPP_ONLY(= 0u);  // of its triangle (shared/triangle_ids.glsl), where a bias asks for ids
};

// The receiver's plane where a ray meets it, as the map stores it. Where the ray does not meet the plane between the
// near and the far end (grazing light) the receiver's own depth stands in.
struct PlaneDepth {
  float depth;
  vec3 posL;
  bool grazing;
};

GNOMON_FN PlaneDepth receiverPlaneDepth(ShadowMap map, int slice, Receiver receiver, Ray ray) {
  PlaneDepth result;
  float t = rayPlaneDistance(ray, receiver.posL, receiver.normalL);
  result.posL = ray.origin + ray.dir * t;
  result.depth = mapDepth(map, slice, result.posL);
  result.grazing = !(t >= 0.0f && result.depth >= 0.0f && result.depth <= 1.0f);
  if (result.grazing) {
    result.posL = receiver.posL;
    result.depth = mapDepth(map, slice, receiver.posL);
  }
  return result;
}

GNOMON_SHARED_END

#include "shared/bias/adaptive.glsl"
#include "shared/bias/bevy.glsl"
#include "shared/bias/constant.glsl"
#include "shared/bias/cosine.glsl"
#include "shared/bias/dual_layer.glsl"
#include "shared/bias/eevee.glsl"
#include "shared/bias/godot.glsl"
#include "shared/bias/moved_lookup.glsl"
#include "shared/bias/none.glsl"
#include "shared/bias/normal_offset.glsl"
#include "shared/bias/receiver_plane.glsl"
#include "shared/bias/second_depth.glsl"
#include "shared/bias/slope.glsl"
#include "shared/bias/unreal_vsm.glsl"
#include "shared/bias/user_knobs.glsl"
#include "shared/bias/user.glsl"

GNOMON_SHARED_BEGIN

// As GNOMON_MAP_KIND in map.glsl.
#ifdef GNOMON_BIAS_METHOD
#define biasMethod(method) GNOMON_BIAS_METHOD
#else
#define biasMethod(method) method
#endif

// Methods that move the receiver before it is looked up and compared, and where to; lists, so that what is compiled of
// them for a constant method is one call, wherever they are expanded (shadow/decide_methods.comp.glsl).
#define GNOMON_MOVING_BIASES(CASE)                                        \
  CASE(kBiasNormalOffset, normalOffsetReceiver(map, params, receiver))    \
  CASE(kBiasEevee, eeveeReceiver(map, receiver))                          \
  CASE(kBiasGodot, godotReceiver(map, receiver))                          \
  CASE(kBiasBevy, bevyReceiver(map, receiver))                            \
  CASE(kBiasUnrealVsm, unrealVsmReceiver(map, receiver))

// How each method decides whether a texel lights the receiver.
#define GNOMON_BIASES(CASE)                                               \
  CASE(kBiasNone, noneLit(map, receiver, tap))                            \
  CASE(kBiasConstant, constantLit(map, params, receiver, tap))            \
  CASE(kBiasSlope, slopeLit(map, params, receiver, tap))                  \
  CASE(kBiasAdaptive, adaptiveLit(map, params, receiver, tap))            \
  CASE(kBiasAdaptiveClamped, adaptiveClampedLit(map, params, receiver, tap)) \
  CASE(kBiasAdaptiveEhm, adaptiveEhmLit(map, params, receiver, tap))      \
  CASE(kBiasNormalOffset, noneLit(map, receiver, tap))                    \
  CASE(kBiasCosine, cosineLit(map, params, receiver, tap))                \
  CASE(kBiasReceiverPlane, receiverPlaneLit(map, params, receiver, tap))  \
  CASE(kBiasSecondDepth, secondDepthLit(map, params, receiver, tap))      \
  CASE(kBiasMidpoint, midpointLit(map, receiver, tap))                    \
  CASE(kBiasDual, dualLit(map, params, receiver, tap))                    \
  CASE(kBiasUser, userLit(map, params, receiver, tap))                    \
  CASE(kBiasEevee, eeveeLit(map, receiver, tap))                          \
  CASE(kBiasGodot, godotLit(map, receiver, tap))                          \
  CASE(kBiasBevy, noneLit(map, receiver, tap))                            \
  CASE(kBiasUnrealVsm, unrealVsmLit(map, receiver, tap))

#define GNOMON_CASE_RETURN(id, value) \
  case id:                            \
    return value;

GNOMON_FN Receiver biasReceiver(int method, ShadowMap map, BiasParams params, Receiver receiver) {
  switch (biasMethod(method)) { GNOMON_MOVING_BIASES(GNOMON_CASE_RETURN) }
  return receiver;
}

// An unknown method sets `known` to false, and the shader paints magenta.
GNOMON_FN bool biasLit(int method, ShadowMap map, BiasParams params, Receiver receiver, Tap tap,
                       GNOMON_OUT(bool) known) {
  known = true;
  if (holdsNothing(tap)) return true;
  switch (biasMethod(method)) { GNOMON_BIASES(GNOMON_CASE_RETURN) }
  known = false;
  return false;
}

GNOMON_FN bool biasMovesReceiver(int method) {
#define GNOMON_CASE_OR(id, value) || method == id
  return false GNOMON_MOVING_BIASES(GNOMON_CASE_OR);
}

GNOMON_SHARED_END
#endif
