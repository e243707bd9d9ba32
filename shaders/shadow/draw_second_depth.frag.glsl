// The second layer: the depth test lets through what lies behind the first, and the blend keeps the nearest of it.
// kMasked leaves the holes of alpha masks open.
#include "shared/scene.glsl"

#include "scene/alpha_mask.glsl"

layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };

layout(constant_id = 0) const int kMasked = 0;

layout(location = 0) in vec2 uv;
layout(location = 1) in flat uint instanceIndex;

layout(location = 0) out float depth;

void main() {
  if (kMasked == 1 && isHole(materials[instances[instanceIndex].material], uv)) discard;
  depth = gl_FragCoord.z;
}
