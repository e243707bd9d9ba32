// Epipolar coordinates of a point light and an eye, and the voxels of a binary volume in them.
// Wyman, "Voxelized Shadow Volumes", HPG 2011; Dou, Yan, Kerzner, Dai, Wyman, "Adaptive Depth Bias for Shadow Maps", JCGT 3(4), 2014, section 3.3.
//
//            P                    L is the light and the origin of the frame, E the eye at distance D,
//           / \                   the frame's z (LightFrame::backW) runs from L to E, its y is the camera's up made perpendicular.
//        r /   \                  theta  azimuth about z, from y towards x, in [-pi, pi]
//         /     \                 phi    angle at L between z and P
//        /phi alp\                alpha  angle at E between E->L and E->P
//       L---------E   z ->
//
// A light ray is one (theta, phi), and alpha grows along it from 0 at L; a view ray is one (theta, alpha), and phi grows
// along it from 0 at E. phi + alpha < pi. Everywhere by atan2: acos loses half its digits where the angles are small.
//
// Voxel (i, j, k) is the box of sides (alphaStep, thetaStep, phiStep); its centre is at (i + 0.5, j + 0.5, k + 0.5) steps. Column (j, k) is the
// light ray through its centre. Occupancy: voxel i of a column is occluded exactly when its centre lies behind the column's
// nearest occluder, alpha_i > alpha_occ.
#ifndef GNOMON_EPIPOLAR_GLSL
#define GNOMON_EPIPOLAR_GLSL

#include "shared/geometry.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

const float kPi = 3.14159265358979f;

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

// Metres from the light along the ray (theta, phi): the law of sines. Infinite where alpha reaches pi - phi.
GNOMON_FN float epipolarDistance(float eyeDistance, float alpha, float phi) {
  float s = sin(phi + alpha);
  return s > 0.0f && phi + alpha < kPi ? eyeDistance * sin(alpha) / s : uintBitsToFloat(0x7f800000u);
}

// d alpha / d r along the ray at distance r from the light.
GNOMON_FN float epipolarAlphaSlope(float eyeDistance, float phi, float r) {
  return eyeDistance * sin(phi) / (eyeDistance * eyeDistance - 2.0f * eyeDistance * r * cos(phi) + r * r);
}

GNOMON_FN float alphaCenter(EpipolarGrid grid, int i) { return grid.alphaLower + (float(i) + 0.5f) * grid.alphaStep; }

// Steps from the lower side; theta goes round, so that what lies below the lower side may lie within from above.
GNOMON_FN float thetaSteps(EpipolarGrid grid, float theta) {
  float turn = 2.0f * kPi;
  float above = theta - grid.thetaLower;
  above = above - floor(above / turn) * turn;
  return above / grid.thetaStep;
}

// The first voxel of a column whose centre lies behind alphaOccluder: 0 .. alphaCount, the count where there is none.
GNOMON_FN int firstOccluded(EpipolarGrid grid, float alphaOccluder) {
  int i = clamp(int(floor((alphaOccluder - grid.alphaLower) / grid.alphaStep + 0.5f)), 0, grid.alphaCount);
  // The quotient rounds; the rule itself decides.
  if (i > 0 && alphaCenter(grid, i - 1) > alphaOccluder) i = i - 1;
  if (i < grid.alphaCount && !(alphaCenter(grid, i) > alphaOccluder)) i = i + 1;
  return i;
}

GNOMON_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(gnomon::glsl::EpipolarGrid) == 40);
#endif
#endif
