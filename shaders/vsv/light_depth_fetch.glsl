// Metres times density between the light and a point, from the table.
#ifndef GNOMON_LIGHT_DEPTH_FETCH_GLSL
#define GNOMON_LIGHT_DEPTH_FETCH_GLSL

#include "shared/density.glsl"
#include "shared/media_pass.glsl"

layout(scalar, binding = kBindLightDepth) readonly buffer LightDepth { float lightDepth[]; };

float depthFromLight(LightReach reach, vec3 fromLight) {
  float r = max(length(fromLight), 1e-6f);
  LightDirection direction = lightDirection(reach, fromLight * (1.0f / r));
  float last = float(kLightDepthSide - 1);
  vec2 at = clamp(direction.uv * last, vec2(0.0f), vec2(last));
  float radii = clamp((r - reach.near_) / (reach.far_ - reach.near_), 0.0f, 1.0f) * float(kLightDepthRadii - 1);
  ivec2 texel = min(ivec2(at), ivec2(kLightDepthSide - 2));
  int radius = min(int(radii), kLightDepthRadii - 2);
  vec2 blend = at - vec2(texel);
  float depths[2];
  for (int n = 0; n < 2; ++n) {
    uint first = lightDepthIndex(direction.slice, radius + n, texel.x, texel.y);
    uint second = lightDepthIndex(direction.slice, radius + n, texel.x, texel.y + 1);
    depths[n] = mix(mix(lightDepth[first], lightDepth[first + 1u], blend.x),
                    mix(lightDepth[second], lightDepth[second + 1u], blend.x), blend.y);
  }
  return mix(depths[0], depths[1], radii - float(radius));
}

#endif
