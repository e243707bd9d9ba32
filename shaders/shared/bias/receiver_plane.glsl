// Receiver-plane bias: the receiver's depth, carried to the tap along the gradient of its plane in the map.
// Isidoro, "Shadow Mapping: GPU-Based Tips and Techniques", GDC 2006.
//
// In a planar map the depth of a plane is affine in (u, v), and this is the adaptive bias's
// intersection by another way.
#ifndef GNOMON_BIAS_RECEIVER_PLANE_GLSL
#define GNOMON_BIAS_RECEIVER_PLANE_GLSL

#include "shared/bias/constant.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kReceiverPlaneOffset = 0;  // metres

// By how much the receiver's plane changes depth from the receiver, which falls on uv of the tap's slice, to the tap.
GNOMON_FN float planeDepthChangeToTap(ShadowMap map, vec2 uv, Receiver receiver, Tap tap) {
  vec2 texel = vec2(1.0f / float(map.width), 1.0f / float(map.height));
  PlaneDepth here = receiverPlaneDepth(map, tap.slice, receiver, mapTexelRay(map, tap.slice, uv));
  PlaneDepth right = receiverPlaneDepth(map, tap.slice, receiver,
                                        mapTexelRay(map, tap.slice, vec2(uv.x + texel.x, uv.y)));
  PlaneDepth below = receiverPlaneDepth(map, tap.slice, receiver,
                                        mapTexelRay(map, tap.slice, vec2(uv.x, uv.y + texel.y)));
  vec2 center = mapTexelCenter(map, tap.texel);
  return (right.depth - here.depth) * ((center.x - uv.x) / texel.x) +
         (below.depth - here.depth) * ((center.y - uv.y) / texel.y);
}

GNOMON_FN bool receiverPlaneLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  float depth = depthTowardsLight(map, tap.slice, receiver.posL, tap.ray, params.knobs[kReceiverPlaneOffset]);
  MapPoint point = mapProject(map, receiver.posL);
  if (point.slice != tap.slice) return depth <= tap.z1;  // a tap across an edge of the map: no gradient leads there
  return depth + planeDepthChangeToTap(map, point.uv, receiver, tap) <= tap.z1;
}

GNOMON_SHARED_END
#endif
