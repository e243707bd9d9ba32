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

// Where the receiver is looked up and compared: at itself, but for methods that move it first.
GNOMON_FN Receiver biasReceiver(int method, ShadowMap map, BiasParams params, Receiver receiver) {
  if (biasMethod(method) == kBiasNormalOffset) return normalOffsetReceiver(map, params, receiver);
  if (biasMethod(method) == kBiasEevee) return eeveeReceiver(map, receiver);
  if (biasMethod(method) == kBiasGodot) return godotReceiver(map, receiver);
  if (biasMethod(method) == kBiasBevy) return bevyReceiver(map, receiver);
  if (biasMethod(method) == kBiasUnrealVsm) return unrealVsmReceiver(map, receiver);
  return receiver;
}

// Whether the texel lights the receiver. An unknown method sets `known` to false, and the shader paints magenta.
GNOMON_FN bool biasLit(int method, ShadowMap map, BiasParams params, Receiver receiver, Tap tap,
                       GNOMON_OUT(bool) known) {
  known = true;
  if (holdsNothing(tap)) return true;
  switch (biasMethod(method)) {
    case kBiasNone:
      return noneLit(map, receiver, tap);
    case kBiasConstant:
      return constantLit(map, params, receiver, tap);
    case kBiasSlope:
      return slopeLit(map, params, receiver, tap);
    case kBiasAdaptive:
      return adaptiveLit(map, params, receiver, tap);
    case kBiasAdaptiveClamped:
      return adaptiveClampedLit(map, params, receiver, tap);
    case kBiasAdaptiveEhm:
      return adaptiveEhmLit(map, params, receiver, tap);
    case kBiasNormalOffset:
      return noneLit(map, receiver, tap);
    case kBiasCosine:
      return cosineLit(map, params, receiver, tap);
    case kBiasReceiverPlane:
      return receiverPlaneLit(map, params, receiver, tap);
    case kBiasSecondDepth:
      return secondDepthLit(map, params, receiver, tap);
    case kBiasMidpoint:
      return midpointLit(map, receiver, tap);
    case kBiasDual:
      return dualLit(map, params, receiver, tap);
    case kBiasUser:
      return userLit(map, params, receiver, tap);
    case kBiasEevee:
      return eeveeLit(map, receiver, tap);
    case kBiasGodot:
      return godotLit(map, receiver, tap);
    case kBiasBevy:
      return noneLit(map, receiver, tap);
    case kBiasUnrealVsm:
      return unrealVsmLit(map, receiver, tap);
  }
  known = false;
  return false;
}

GNOMON_SHARED_END
#endif
