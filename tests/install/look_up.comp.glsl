// An engine's own shader: points and normals in the light's frame, and the depth that its map holds for each, to light
// and shadow by two biases. tests/install/run puts the version and the extensions before it.
#include "shared/map.glsl"
#include "shared/bias.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Receivers { Receiver receivers[]; };
layout(scalar, binding = 1) readonly buffer Depths { float depths[]; };
layout(scalar, binding = 2) writeonly buffer Lit { uvec2 lit[]; };
layout(scalar, push_constant) uniform Push {
  BiasParams params;
  uint count;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  MapPoint point = mapProject(shadowMap, receivers[i].posL);
  Tap tap;
  tap.slice = point.slice;
  tap.texel = mapTexel(shadowMap, point.uv);
  tap.ray = mapTexelRay(shadowMap, tap.slice, mapTexelCenter(shadowMap, tap.texel));
  tap.z1 = depths[i];
  tap.z2 = 1.0f;
  bool known;
  lit[i].x = biasLit(kBiasConstant, shadowMap, params, receivers[i], tap, known) ? 1u : 0u;
  lit[i].y = biasLit(kBiasAdaptive, shadowMap, params, receivers[i], tap, known) ? 1u : 0u;
}
