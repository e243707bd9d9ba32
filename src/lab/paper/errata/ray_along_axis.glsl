//! name: ray-along-the-axis
//! sentence: The adaptive bias of Dou et al. 2014 on a paraboloid, its ray as section 3.2 prints it: R = 2 (d0 . N) d0 - d0.
//! knob: k one 0 1 0.0001
#ifndef RAY_ALONG_AXIS_GLSL
#define RAY_ALONG_AXIS_GLSL

#include "shared/bias.glsl"

GNOMON_SHARED_BEGIN

// Section 3.2: (x, y) is the texel's centre on the paraboloid's disc, zH the height of the paraboloid above it.
GNOMON_FN bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  vec2 uv = mapTexelCenter(map, tap.texel);
  float x = uv.x * 2.0f - 1.0f;
  float y = 1.0f - uv.y * 2.0f;
  float zH = 0.5f - 0.5f * (x * x + y * y);
  // d0 stands where the reflection has N, so that R has no part across the axis; d0 . N = 1 / zH.
  vec3 ray = vec3(0.0f, 0.0f, paraboloidAxisZ(tap.slice) * sign(2.0f / zH - 1.0f));
  float approach = dot(receiver.normalL, ray);
  float distance_ = approach == 0.0f ? -1.0f : dot(receiver.normalL, receiver.posL) / approach;
  float depth = (distance_ - map.zNear) / (map.zFar - map.zNear);
  if (!(distance_ >= 0.0f && depth >= 0.0f && depth <= 1.0f)) depth = mapDepth(map, tap.slice, receiver.posL);
  float epsilon = map.sceneScale * params.knobs[kUserK] / (map.zFar - map.zNear);
  return depth - epsilon <= tap.z1;
}

GNOMON_SHARED_END
#endif
