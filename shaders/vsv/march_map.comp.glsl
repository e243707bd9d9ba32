// In-scattered light of a homogeneous medium by ray marching: samples at equal distances along the view ray, each
// looked up in a shadow map. The baseline that most engines use today.
#include "shared/map.glsl"
#include "shared/media_pass.glsl"

layout(scalar, push_constant) uniform Push { MediaPush push; };

#include "vsv/view_ray.glsl"

layout(local_size_x = kMediaGroupSide, local_size_y = kMediaGroupSide) in;

layout(constant_id = 0) const int kMapKind = kMapCube;

#include "vsv/map_lit.glsl"

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
    if (inCone && isMapLit(map, posL)) sum += scatteredPerMetre(media.medium, posL, dirL, s + r);
  }
  scatter(pixel, sum * stepLength * push.intensity);
}
