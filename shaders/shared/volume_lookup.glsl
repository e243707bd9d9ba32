// The biases of a shadow volume, which has one bit a voxel and no depths: they choose the voxel that decides whether a
// receiver is lit.
// Dou, Yan, Kerzner, Dai, Wyman, "Adaptive Depth Bias for Shadow Maps", JCGT 3(4), 2014, section 3.3, Algorithm 2.
//
//   none       the voxel that holds the receiver
//   constant   the voxel that holds the receiver moved `offset` metres towards the light along the column's ray
//   adaptive   F' is where the column's ray meets the receiver's plane, and i the voxel that holds it: voxel i where
//              F' is at or behind the centre of i, else its neighbour nearer the light. With the occupancy rule
//              (alpha_i > alpha_occ) that is exact wherever nothing but the receiver's plane is in the way: the chosen
//              voxel's centre is the last that is not behind F'.
//
//        |  i-1  |   i   |  i+1  |      alpha grows away from the light
//        |   .   |   .   |   .   |      centres
//               F'                      before the centre of i: look up i-1
//
// The bit of a column without occluder is 0 throughout, and a voxel before the first (-1) is lit: there
// is nothing of the column.
#ifndef GNOMON_VOLUME_LOOKUP_GLSL
#define GNOMON_VOLUME_LOOKUP_GLSL

#include "shared/bias.glsl"
#include "shared/epipolar.glsl"
#include "shared/lang.glsl"
#include "shared/map.glsl"

GNOMON_SHARED_BEGIN

// What the alphas of two points on one plane and one ray may differ by though they are the same, radians. Each is an
// atan2 of arguments good to a few 2^-24, and its polynomial rounds by some ulps of pi more (2.4e-7 each); the
// occluder's was divided and multiplied by the upper alpha, two more. Eight ulps of pi in all: a six hundredth of a
// voxel where 1024 of them span pi. The paper's epsilon is metres and says nothing here, since far from light and eye
// many metres are less than an ulp of alpha.
const float kAlphaRounding = 2e-6f;

GNOMON_FN int voxelHolding(EpipolarGrid grid, float alpha) {
  return int(clamp(floor((alpha - grid.alphaLower) / grid.alphaStep), -1.0f, float(grid.alphaCount - 1)));
}

// The last voxel whose centre is not behind alpha.
GNOMON_FN int voxelNotBehind(EpipolarGrid grid, float alpha) { return firstOccluded(grid, alpha) - 1; }

// The bits hold no depth: where epsilon is wanted at the stored one, it is taken at F'.
GNOMON_FN float adaptiveAlpha(ShadowMap map, BiasParams params, Receiver receiver, Ray ray) {
  PlaneDepth occluder = receiverPlaneDepth(map, 0, receiver, ray);
  vec3 atL = params.epsilonAt == kEpsilonAtFragment ? receiver.posL : occluder.posL;
  float epsilon = mapDepthSlope(map, 0, atL, ray.dir) * map.sceneScale * params.knobs[kAdaptiveK];
  return (occluder.depth - epsilon) * alphaUpper(map.epipolar) - kAlphaRounding;
}

// Where the column's ray never comes to the receiver's alpha, that is at infinity, metres are nothing.
GNOMON_FN float constantAlpha(ShadowMap map, BiasParams params, Receiver receiver, Ray ray) {
  float depth = mapDepth(map, 0, receiver.posL);
  float along = mapDistance(map, 0, ray, depth);
  if (along < uintBitsToFloat(0x7f800000u))
    depth = mapDepth(map, 0, ray.dir * max(along - params.knobs[kConstantOffset], 0.0f));
  return depth * alphaUpper(map.epipolar);
}

// The voxel of the column through `ray` whose bit decides; -1: lit. An unknown method sets `known` to false.
GNOMON_FN int decidingVoxel(int method, ShadowMap map, BiasParams params, Receiver receiver, Ray ray,
                            GNOMON_OUT(bool) known) {
  known = true;
  switch (method) {
    case kBiasNone:
      return voxelHolding(map.epipolar, mapDepth(map, 0, receiver.posL) * alphaUpper(map.epipolar));
    case kBiasConstant:
      return voxelHolding(map.epipolar, constantAlpha(map, params, receiver, ray));
    case kBiasAdaptive:
      return voxelNotBehind(map.epipolar, adaptiveAlpha(map, params, receiver, ray));
  }
  known = false;
  return -1;
}

GNOMON_SHARED_END
#endif
