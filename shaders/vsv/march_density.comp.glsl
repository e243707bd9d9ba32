// Light scattered towards the eye by a medium of varying density: samples along what of the view ray lies in the grid
// (shared/march_steps.glsl), attenuated towards the eye by what was passed so far and towards the light by the table,
// with visibility from the bits of a shadow volume or from a shadow map.
#include "shared/map.glsl"
#include "shared/march_steps.glsl"
#include "shared/media_pass.glsl"
#include "shared/shade.glsl"
#include "shared/volume.glsl"

#include "vsv/density_fetch.glsl"

layout(local_size_x = kMediaGroupSide, local_size_y = kMediaGroupSide) in;

layout(constant_id = 0) const int kMapKind = kMapEpipolar;  // epipolar: the bits

layout(scalar, push_constant) uniform Push { DensityPush densityPush; };
#define push densityPush.light

#include "vsv/light_depth_fetch.glsl"
#include "vsv/view_ray.glsl"
#include "vsv/map_lit.glsl"

layout(scalar, binding = kBindBits) readonly buffer Bits { uint words[]; };
layout(scalar, binding = kBindEyeDepth) writeonly buffer EyeDepth { float eyeDepth[]; };

// The row of texels of the view ray, and what its voxels are found by.
struct BitRow {
  uint texel;
  float sinAlpha, cosAlpha;
};

BitRow bitRow(EpipolarGrid grid, vec3 dirL) {
  BitRow row;
  row.sinAlpha = sqrt(dirL.x * dirL.x + dirL.y * dirL.y);
  row.cosAlpha = -dirL.z;
  int i = clamp(int(floor((atan2(row.sinAlpha, row.cosAlpha) - grid.alphaLower) / grid.alphaStep)), 0,
                grid.alphaCount - 1);
  int k = clamp(int(thetaSteps(grid, atan2(dirL.x, dirL.y))), 0, grid.thetaCount - 1);
  row.texel = epipolarTexelIndex(grid, i, k, 0);
  return row;
}

bool isBitLit(EpipolarGrid grid, BitRow row, float s) {
  float phi = phiOnViewRay(grid.eyeDistance, row.sinAlpha, row.cosAlpha, s);
  int j = clamp(int(floor((phi - grid.phiLower) / grid.phiStep)), 0, grid.phiCount - 1);
  uint texel = row.texel + uint(j / kPhiBits * grid.alphaCount * kThetaBlock);
  return (words[texel * 4u + uint(j % kPhiBits / 32)] >> uint(j % 32) & 1u) == 0u;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= media.camera.width || pixel.y >= media.camera.height) return;
  ShadowMap map = shadowMap;
  map.kind = kMapKind;
  ViewRay ray = fetchViewRay(pixel);
  vec3 dirL = directionFromWorld(lightFrame, ray.dirW);
  vec3 eyeL = lightFromWorld(lightFrame, media.camera.eyeW);
  BitRow row = bitRow(map.epipolar, dirL);
  vec2 within = rayWithinBounds(density, media.camera.eyeW, ray.dirW, ray.end);
  vec3 eyeI = indexFromWorld(density, media.camera.eyeW);
  vec3 dirI = indexDirection(density, ray.dirW);

  vec3 toLight = push.lightW - media.camera.eyeW;
  float foot = dot(toLight, ray.dirW);
  float aside = max(length(toLight - ray.dirW * foot), 1e-6f);  // of the lamp itself a micrometre
  MarchSteps march = marchSteps(within.x, within.y, foot, aside, push.steps);
  float passed = 0.0f;  // metres times density
  vec3 sum = vec3(0.0f);
  float begin = within.x;
  for (int n = 0; n < push.steps && within.x < within.y; ++n) {
    float end = nextStepEnd(march);
    float s = foot + middleByAngle(begin - foot, end - foot, aside);
    float here = densityAtIndex(eyeI + dirI * s);
    vec3 fromLight = media.camera.eyeW + ray.dirW * s - push.lightW;
    bool lit = kMapKind == kMapEpipolar ? isBitLit(map.epipolar, row, s) : isMapLit(map, eyeL + dirL * s);
    lit = lit && (push.coneCos <= -1.0f || dot(fromLight, push.coneAxisW) >= push.coneCos * length(fromLight));
    float along = here * (end - begin);
    if (lit && here > 0.0f)
      sum += scatteredAtUnitDistance(media.medium, fromLight, ray.dirW,
                                     passed + 0.5f * along + depthFromLight(densityPush.reach, fromLight)) *
             (here * inverseSquareBetween(begin - foot, end - foot, aside));
    passed += along;
    begin = end;
  }
  eyeDepth[pixel.y * media.camera.width + pixel.x] = passed;
  scatter(pixel, sum * push.intensity);
}
