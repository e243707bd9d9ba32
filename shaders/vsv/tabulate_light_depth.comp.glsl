// How much density lies between the light and points about it: summed outwards along each direction,
// a value at each radius.
#include "shared/density.glsl"
#include "shared/media_pass.glsl"

#include "vsv/density_fetch.glsl"

layout(local_size_x = kMediaGroupSide, local_size_y = kMediaGroupSide) in;

layout(scalar, binding = kBindLightDepth) writeonly buffer LightDepth { float lightDepth[]; };
layout(scalar, push_constant) uniform Push { DensityPush push; };

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (texel.x >= kLightDepthSide || texel.y >= kLightDepthSide) return;
  vec2 uv = vec2(float(texel.x), float(texel.y)) * (1.0f / float(kLightDepthSide - 1));
  vec3 dirW = directionFromLight(push.reach, texel.z, uv);
  vec3 origin = indexFromWorld(density, push.light.lightW);
  vec3 dir = indexDirection(density, dirW);
  float stepLength = (push.reach.far_ - push.reach.near_) / float((kLightDepthRadii - 1) * push.reach.substeps);
  float sum = 0.0f;
  int stepped = 0;
  for (int radius = 0; radius < kLightDepthRadii; ++radius) {
    lightDepth[lightDepthIndex(texel.z, radius, texel.x, texel.y)] = sum * stepLength;
    for (int n = 0; n < push.reach.substeps; ++n, ++stepped) {
      vec3 posI = origin + dir * (push.reach.near_ + (float(stepped) + 0.5f) * stepLength);
      if (all(greaterThanEqual(posI, density.lowerI)) && all(lessThanEqual(posI, density.upperI)))
        sum += densityAtIndex(posI);
    }
  }
}
