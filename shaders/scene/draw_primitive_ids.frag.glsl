// Writes which triangle of which instance a pixel sees. kMasked honours alpha masks.
#include "shared/scene.glsl"

#include "scene/alpha_mask.glsl"

layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };

layout(constant_id = 0) const int kMasked = 0;

layout(location = 0) in vec2 uv;
layout(location = 1) in flat uint instanceIndex;
layout(location = 2) in flat uint firstTriangle;

layout(location = 0) out uvec2 primitiveId;

void main() {
  if (kMasked == 1 && isHole(materials[instances[instanceIndex].material], uv)) discard;
  primitiveId = uvec2(instanceIndex + 1u, firstTriangle + gl_PrimitiveID);
}
