// Adaptive bias: Dou, Yan, Kerzner, Dai, Wyman, "Adaptive Depth Bias for Shadow Maps", JCGT 3(4), 2014, section 2.
//
//        light               F   the receiver
//         /|                 R   the ray through the centre of F's texel
//        / |                 F'  where R meets the plane of F: what the map would hold there
//       R  |                     if nothing but that plane were in the way
//      /   |
//   --F'---F-- plane         lit  <=>  d(F') - eps <= z1,   eps = f'(x) * sceneScale * K
//
// Differs from the paper: the text takes f' at the fragment, Algorithm 1 at F', the listings at the stored depth
// (epsilonAt chooses); equation 6 has a wrong sign on b, which does not reach equation 10, and f' is taken here from
// mapDepthSlope, so that it holds for every map.
#ifndef GNOMON_BIAS_ADAPTIVE_GLSL
#define GNOMON_BIAS_ADAPTIVE_GLSL

#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const int kAdaptiveK = 0;  // of the scene's scale; the three methods share it

GNOMON_FN float adaptiveEpsilon(ShadowMap map, BiasParams params, Receiver receiver, Tap tap, vec3 occluderL) {
  vec3 atL = occluderL;
  if (params.epsilonAt == kEpsilonAtFragment) atL = receiver.posL;
  if (params.epsilonAt == kEpsilonAtStored) {
    atL = tap.ray.origin + tap.ray.dir * mapDistance(map, tap.slice, tap.ray, tap.z1);
  }
  return mapDepthSlope(map, tap.slice, atL, tap.ray.dir) * map.sceneScale * params.knobs[kAdaptiveK];
}

GNOMON_FN bool adaptiveLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  PlaneDepth occluder = receiverPlaneDepth(map, tap.slice, receiver, tap.ray);
  return occluder.depth - adaptiveEpsilon(map, params, receiver, tap, occluder.posL) <= tap.z1;
}

// The authors' own shaders never take a depth behind the receiver's, which the text does not say.
GNOMON_FN bool adaptiveClampedLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  PlaneDepth occluder = receiverPlaneDepth(map, tap.slice, receiver, tap.ray);
  float depth = min(occluder.depth, mapDepth(map, tap.slice, receiver.posL));
  return depth - adaptiveEpsilon(map, params, receiver, tap, occluder.posL) <= tap.z1;
}

// Ehm et al., WSCG 2015: epsilon grows as the light grazes.
GNOMON_FN bool adaptiveEhmLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  PlaneDepth occluder = receiverPlaneDepth(map, tap.slice, receiver, tap.ray);
  float facing = dot(receiver.normalL, tap.ray.dir);
  float grow = min(1.0f / max(facing * facing, 1e-6f), 100.0f);
  return occluder.depth - adaptiveEpsilon(map, params, receiver, tap, occluder.posL) * grow <= tap.z1;
}

GNOMON_SHARED_END
#endif
