// The light's frame L: origin at the light (a directional light: a point near the scene), axes unit and orthogonal,
// looking along -z. The origin is subtracted before the rotation, so that what is near the light keeps its digits.
#ifndef GNOMON_LIGHT_FRAME_GLSL
#define GNOMON_LIGHT_FRAME_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

struct LightFrame {
  vec3 originW;  // metres
  vec3 rightW;   // x of L
  vec3 upW;      // y of L
  vec3 backW;    // z of L: the light looks along -z
};

GNOMON_FN vec3 directionFromWorld(LightFrame frame, vec3 dirW) {
  return vec3(dot(frame.rightW, dirW), dot(frame.upW, dirW), dot(frame.backW, dirW));
}

GNOMON_FN vec3 lightFromWorld(LightFrame frame, vec3 posW) {
  return directionFromWorld(frame, posW - frame.originW);
}

GNOMON_FN vec3 worldFromLight(LightFrame frame, vec3 posL) {
  return frame.originW + frame.rightW * posL.x + frame.upW * posL.y + frame.backW * posL.z;
}

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::LightFrame) == 48);
#endif
#endif
