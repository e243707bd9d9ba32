// Light scattered towards the eye by a homogeneous medium, sampled at equal distances along the view ray, each sample looked up in a shadow
// map: what people have today, to compare with.
#include "shared/map.glsl"
#include "shared/media_pass.glsl"
#include "shared/shade.glsl"

#include "vsv/view_ray.glsl"

layout(local_size_x = kMediaGroupSide, local_size_y = kMediaGroupSide) in;

layout(constant_id = 0) const int kMapKind = kMapCube;

layout(binding = kBindMapDepth) uniform texture2DArray mapDepthLayers;

// Without bias: there is no surface at a sample to shadow itself. A texel in which nothing was drawn shadows nothing.
bool isLit(ShadowMap map, vec3 posL) {
  MapPoint point = mapProject(map, posL);
  if (!point.covered) return true;
  float stored = texelFetch(mapDepthLayers, ivec3(mapTexel(map, point.uv), point.layer), 0).x;
  return stored >= 1.0f || mapDepth(map, point.layer, posL) < stored;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= media.camera.width || pixel.y >= media.camera.height) return;
  ShadowMap map = shadowMap;
  map.kind = kMapKind;
  ViewRay ray = fetchViewRay(pixel);
  vec3 dirL = directionFromWorld(lightFrame, ray.dirW);
  vec3 eyeL = lightFromWorld(lightFrame, media.camera.eyeW);
  vec3 coneAxisL = directionFromWorld(lightFrame, push.coneAxisW);
  float stepLength = ray.end / float(push.steps);
  vec3 sum = vec3(0.0f);
  for (int n = 0; n < push.steps; ++n) {
    float s = (float(n) + 0.5f) * stepLength;
    vec3 posL = eyeL + dirL * s;
    float r = length(posL);
    bool inCone = push.coneCos <= -1.0f || dot(posL, coneAxisL) >= push.coneCos * r;
    if (inCone && isLit(map, posL)) sum += scatteredPerMetre(media.medium, posL, dirL, s + r);
  }
  scatter(pixel, sum * stepLength * push.intensity);
}
