// Another renderer's shader: a lamp with a cube map and a sun with a planar one, by the headers of gnomon/glsl.
// tests/install/run puts the version and the extensions before it.
#include "gnomon/glsl/visibility.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2DArray lampDepth;
layout(binding = 1) uniform sampler2DArray sunDepth;
layout(scalar, binding = 2) uniform Maps {
  GnomonShadowMap lamp, sun;
  GnomonMapSlice sunSlice;
};
layout(scalar, binding = 3) readonly buffer Points { vec3 points[]; };
layout(scalar, binding = 4) writeonly buffer Lit { vec2 lit[]; };

float gnomonFetchDepth(int source, int slice, ivec2 texel) {
  ivec3 at = ivec3(texel, slice);
  return source == 0 ? texelFetch(lampDepth, at, 0).x : texelFetch(sunDepth, at, 0).x;
}
GnomonMapSlice gnomonMapSlice(int source, int slice) { return sunSlice; }

void main() {
  uint i = gl_GlobalInvocationID.x;
  vec3 place = points[2u * i], normal = points[2u * i + 1u];
  GnomonReceiver byLamp = gnomonReceiverAt(lamp.frame, place, normal, 0u);
  GnomonReceiver bySun = gnomonReceiverAt(sun.frame, place, normal, 0u);
  GnomonMapPoint lampPoint = gnomonMapProject(lamp, byLamp.posL), sunPoint = gnomonMapProject(sun, bySun.posL);
  GnomonBiasParams params;
  params.knobs[0] = 0.01f;
  GnomonTap tap = gnomonEmptyTap(lampPoint.slice, gnomonMapTexel(lamp, lampPoint.uv),
                                 gnomonMapTexelRay(lamp, lampPoint.slice, lampPoint.uv));
  tap.z1 = gnomonFetchDepth(0, tap.slice, tap.texel);
  lit[i].x = gnomonBiasLit(kGnomonBiasConstant, lamp, params, byLamp, tap) ? 1.0f : 0.0f;
  tap.texel = gnomonMapTexel(sun, sunPoint.uv);
  tap.slice = sunPoint.slice;
  tap.ray = gnomonMapTexelRay(sun, tap.slice, gnomonMapTexelCenter(sun, tap.texel));
  tap.z1 = gnomonFetchDepth(1, tap.slice, tap.texel);
  lit[i].y = gnomonBiasLit(kGnomonBiasConstant, sun, params, bySun, tap) ? 1.0f : 0.0f;
}
