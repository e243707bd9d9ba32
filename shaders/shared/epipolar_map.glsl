// The columns of a shadow volume as a map: one layer, theta along u, phi along v, and depth = alpha / (the volume's
// upper alpha). Part of shared/map.glsl, which includes it after the structs; epipolar.glsl has the coordinates.
//
// Depth is 0 at the light whatever alpha the volume begins with, so that a caster before the volume still shadows all
// of it, and a texel's ray begins at the light, where alpha is 0 on every ray.
#ifndef GNOMON_EPIPOLAR_MAP_GLSL
#define GNOMON_EPIPOLAR_MAP_GLSL

#include "shared/epipolar.glsl"
#include "shared/geometry.glsl"
#include "shared/lang.glsl"

GNOMON_SHARED_BEGIN

GNOMON_FN MapPoint epipolarMapProject(ShadowMap map, vec3 posL) {
  EpipolarGrid grid = map.epipolar;
  EpipolarPoint at = epipolarFromLight(grid.eyeDistance, posL);
  MapPoint point;
  point.slice = 0;
  point.uv = vec2(thetaSteps(grid, at.theta) / float(grid.thetaCount),
                  (at.phi - grid.phiLower) / (float(grid.phiCount) * grid.phiStep));
  point.covered = point.uv.x <= 1.0f && point.uv.y >= 0.0f && point.uv.y <= 1.0f && dot(posL, posL) > 0.0f;
  return point;
}

GNOMON_FN Ray epipolarMapTexelRay(ShadowMap map, vec2 uv) {
  EpipolarGrid grid = map.epipolar;
  Ray ray;
  ray.origin = vec3(0.0f, 0.0f, 0.0f);
  ray.dir = epipolarDirection(grid.thetaLower + uv.x * (float(grid.thetaCount) * grid.thetaStep),
                              grid.phiLower + uv.y * (float(grid.phiCount) * grid.phiStep));
  return ray;
}

GNOMON_FN float epipolarMapDepth(ShadowMap map, vec3 posL) {
  return epipolarFromLight(map.epipolar.eyeDistance, posL).alpha / alphaUpper(map.epipolar);
}

// What the map is drawn with: columns along theta, theta at the first one's side and at the last one's less that, the
// eye's distance; the same of phi, and the upper alpha. By these the two below give the bits of those above.
GNOMON_FN vec4 epipolarMapThetaNumbers(ShadowMap map) {
  EpipolarGrid grid = map.epipolar;
  return vec4(float(map.width), grid.thetaLower, float(grid.thetaCount) * grid.thetaStep, grid.eyeDistance);
}

GNOMON_FN vec4 epipolarMapPhiNumbers(ShadowMap map) {
  EpipolarGrid grid = map.epipolar;
  return vec4(float(map.height), grid.phiLower, float(grid.phiCount) * grid.phiStep, alphaUpper(grid));
}

GNOMON_FN vec3 epipolarMapDrawnRay(vec4 theta, vec4 phi, vec2 center) {
  return epipolarDirection(theta.y + center.x / theta.x * theta.z, phi.y + center.y / phi.x * phi.z);
}

GNOMON_FN float epipolarMapDrawnDepth(vec4 theta, vec4 phi, vec3 posL) {
  return epipolarAlpha(theta.w, posL) / phi.w;
}

GNOMON_FN float epipolarMapDepthSlope(ShadowMap map, vec3 posL, vec3 rayDir) {
  return epipolarAlphaSlope(map.epipolar.eyeDistance, rayDir, length(posL)) / alphaUpper(map.epipolar);
}

GNOMON_FN float epipolarMapDistance(ShadowMap map, Ray ray, float depth) {
  return epipolarDistance(map.epipolar.eyeDistance, depth * alphaUpper(map.epipolar), ray.dir);
}

GNOMON_SHARED_END
#endif
