// Epipolar coordinates of a point light and an eye, and the voxels of a binary volume in them.
// Wyman, "Voxelized Shadow Volumes", HPG 2011; Dou, Yan, Kerzner, Dai, Wyman, "Adaptive Depth Bias for Shadow Maps",
// JCGT 3(4), 2014, section 3.3.
//
//            P                    L is the light and the origin of the frame, E the eye at distance D,
//           / \                   its z (LightFrame::backW) runs from L to E, its y is the camera's up, projected.
//        r /   \                  theta  azimuth about z, from y towards x, in [-pi, pi]
//         /     \                 phi    angle at L between z and P
//        /phi alp\                alpha  angle at E between E->L and E->P
//       L---------E   z ->
//
// A light ray is one (theta, phi), and alpha grows along it from 0 at L; a view ray is one (theta, alpha), and phi
// grows along it from 0 at E. phi + alpha < pi. Everywhere by atan2: acos loses half its digits where the angles are
// small. Where L and E are one point there is no axis, and no such coordinates.
//
// Voxel (i, j, k) is the box of sides (alphaStep, thetaStep, phiStep); its centre is at (i + 0.5, j + 0.5, k + 0.5)
// steps. Column (j, k) is the light ray through its centre. Occupancy: voxel i of a column is occluded exactly when its
// centre lies behind the column's nearest occluder, alpha_i > alpha_occ.
#ifndef GNOMON_EPIPOLAR_GLSL
#define GNOMON_EPIPOLAR_GLSL

#include "shared/geometry.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const float kPi = 3.14159265358979f;
const int kPhiBits = 128;         // voxels of a texel of the volume: a uvec4
const int kThetaBlock = 8;        // columns of texels that lie side by side in memory

struct EpipolarGrid {
  float eyeDistance;  // D, metres
  float alphaLower;   // radians, of the lower side of voxel 0
  float alphaStep;
  float thetaLower;
  float thetaStep;
  float phiLower;
  float phiStep;
  int alphaCount;
  int thetaCount;
  int phiCount;  // a multiple of 128
};

struct EpipolarPoint {
  float alpha;
  float theta;
  float phi;
};

GNOMON_FN float epipolarAlpha(float eyeDistance, vec3 posL) {
  return atan2(sqrt(posL.x * posL.x + posL.y * posL.y), eyeDistance - posL.z);
}

GNOMON_FN EpipolarPoint epipolarFromLight(float eyeDistance, vec3 posL) {
  float aside = sqrt(posL.x * posL.x + posL.y * posL.y);
  EpipolarPoint point;
  point.theta = atan2(posL.x, posL.y);
  point.phi = atan2(aside, posL.z);
  point.alpha = atan2(aside, eyeDistance - posL.z);
  return point;
}

GNOMON_FN vec3 epipolarDirection(float theta, float phi) {
  float s = sin(phi);
  return vec3(s * sin(theta), s * cos(theta), cos(phi));
}

// Metres from the light along the unit direction `dir` to where alpha is `alpha`: the law of sines, with sin(phi +
// alpha) = sin phi cos alpha + cos phi sin alpha. Infinite where alpha reaches pi - phi.
GNOMON_FN float epipolarDistance(float eyeDistance, float alpha, vec3 dir) {
  float s = sin(alpha);
  float sum = sqrt(dir.x * dir.x + dir.y * dir.y) * cos(alpha) + dir.z * s;
  return sum > 0.0f ? eyeDistance * s / sum : uintBitsToFloat(0x7f800000u);
}

// d alpha / d r along the unit direction `dir` at distance r from the light: alpha = atan2(r sin phi, D - r cos phi).
GNOMON_FN float epipolarAlphaSlope(float eyeDistance, vec3 dir, float r) {
  return eyeDistance * sqrt(dir.x * dir.x + dir.y * dir.y) /
         (eyeDistance * eyeDistance - 2.0f * eyeDistance * r * dir.z + r * r);
}

GNOMON_FN float alphaUpper(EpipolarGrid grid) { return grid.alphaLower + float(grid.alphaCount) * grid.alphaStep; }

GNOMON_FN float phiUpper(EpipolarGrid grid) { return grid.phiLower + float(grid.phiCount) * grid.phiStep; }

GNOMON_FN float alphaCenter(EpipolarGrid grid, int i) { return grid.alphaLower + (float(i) + 0.5f) * grid.alphaStep; }

// Whether the columns go all the way round, so that the first stands beside the last.
GNOMON_FN bool thetaGoesRound(EpipolarGrid grid) {
  return (float(grid.thetaCount) + 0.5f) * grid.thetaStep > 2.0f * kPi;
}

// Steps from the lower side, never negative; theta goes round, so that what lies below the lower side
// may lie within from above.
GNOMON_FN float thetaSteps(EpipolarGrid grid, float theta) {
  float turn = 2.0f * kPi;
  float above = theta - grid.thetaLower;
  above = max(above - floor(above / turn) * turn, 0.0f);
  float steps = above / grid.thetaStep;
  return thetaGoesRound(grid) ? min(steps, float(grid.thetaCount)) : steps;
}

// The first voxel of a column whose centre lies behind alphaOccluder: 0 .. alphaCount, the count where there is none.
GNOMON_FN int firstOccluded(EpipolarGrid grid, float alphaOccluder) {
  int i = int(clamp(floor((alphaOccluder - grid.alphaLower) / grid.alphaStep + 0.5f), 0.0f, float(grid.alphaCount)));
  // The quotient rounds; the rule itself decides.
  if (i > 0 && alphaCenter(grid, i - 1) > alphaOccluder) i = i - 1;
  if (i < grid.alphaCount && !(alphaCenter(grid, i) > alphaOccluder)) i = i + 1;
  return i;
}

// Where the texel with the bits phi = 128 block .. 128 block + 127 of (alpha i, theta k) lies: phi bit j is bit j
// % 32 of its word j / 32.
//
// Eight neighbouring columns of texels lie side by side, 128 bytes, and on from there along alpha, so that the scan
// walks through memory; rows of the whole theta, a power of two of bytes apart, take 1.6 times as long (1024 x 1024 x
// 512 on lavapipe: 5.0 copies of the volume against 3.3).
GNOMON_FN uint epipolarTexelIndex(EpipolarGrid grid, int i, int k, int block) {
  int blocks = (k / kThetaBlock) * (grid.phiCount / kPhiBits) + block;
  return uint(blocks * grid.alphaCount + i) * uint(kThetaBlock) + uint(k % kThetaBlock);
}

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::EpipolarGrid) == 40);
#endif
#endif
