// What Unreal Engine 5's virtual shadow maps do (VirtualShadowMapProjectionCommon.ush, "optimal slope bias" and the
// normal bias, 5.1):
//
//   looked up at   P + N 0.0002 m
//   stored depth   + 2 max(0, g . (c - uv))    g: the change of the receiver plane's depth with uv, towards the light;
//                                              c: the texel's centre; at most 1 m
//
// Differs: the offset along the normal is the engine's least one; it grows with the distance from the camera, which no
// bias here knows. The bound of the slope is in depth units there, 1 m for a directional light and hardly ever reached
// for others; here it is 1 m along the ray. Its ray marching and its trace in screen space are left out.
#ifndef GNOMON_BIAS_UNREAL_VSM_GLSL
#define GNOMON_BIAS_UNREAL_VSM_GLSL

#include "shared/bias/constant.glsl"
#include "shared/bias/moved_lookup.glsl"
#include "shared/bias/receiver_plane.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

GNOMON_FN Receiver unrealVsmReceiver(ShadowMap map, Receiver receiver) {
  return movedWithin(map, receiver, receiver.posL + receiver.normalL * 0.0002f);
}

GNOMON_FN bool unrealVsmLit(ShadowMap map, Receiver receiver, Tap tap) {
  float depth = mapDepth(map, tap.slice, receiver.posL);
  MapPoint point = mapProject(map, receiver.posL);
  if (point.slice != tap.slice) return depth <= tap.z1;
  float towardsLight = max(-planeDepthChangeToTap(map, point.uv, receiver, tap), 0.0f);
  float atMost = depth - depthTowardsLight(map, tap.slice, receiver.posL, tap.ray, 1.0f);
  return depth - min(2.0f * towardsLight, atMost) <= tap.z1;
}

GNOMON_SHARED_END
#endif
