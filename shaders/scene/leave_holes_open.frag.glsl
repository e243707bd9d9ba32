// Depth alone, with the holes of alpha masks left open.
#include "shared/scene.glsl"

#include "scene/alpha_mask.glsl"

layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };

layout(location = 0) in vec2 uv;
layout(location = 1) in flat uint instanceIndex;

void main() {
  if (isHole(materials[instances[instanceIndex].material], uv)) discard;
}
