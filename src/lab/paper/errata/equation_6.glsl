//! name: equation-6-as-printed
//! sentence: The adaptive bias of Dou et al. 2014, its depth by equation 6 as the paper prints it.
//! knob: k one 0 1 0.0001
#ifndef EQUATION_6_GLSL
#define EQUATION_6_GLSL

#include "shared/bias.glsl"

GNOMON_SHARED_BEGIN

// On a cube map, whose faces have the perspective of equations 4 to 6 along their axes. x is the
// real depth in [-lf, -ln].
GNOMON_FN bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  PlaneDepth plane = receiverPlaneDepth(map, tap.slice, receiver, tap.ray);
  float ln = map.zNear;
  float lf = map.zFar;
  float a = -(lf + ln) / (lf - ln);
  float b = -2.0f * lf * ln / (lf - ln);
  float x = -(lf * ln) / (lf - plane.depth * (lf - ln));
  float depth = (-a * x + b) / (2.0f * x) + 0.5f;
  float rest = lf - depth * (lf - ln);
  float epsilon = rest * rest / (lf * ln * (lf - ln)) * map.sceneScale * params.knobs[kUserK];  // equation 10
  return depth - epsilon <= tap.z1;
}

GNOMON_SHARED_END
#endif
