// A fragment of a map whose depth is the rasterizer's own. kMasked leaves the holes of alpha masks open. Where there is
// nothing to store but that depth, opaque meshes are drawn without a fragment shader.
#include "shared/scene.glsl"

#include "scene/alpha_mask.glsl"
#include "shadow/store_channels.glsl"

layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };

layout(constant_id = 0) const int kMasked = 0;

layout(location = 0) in vec2 uv;
layout(location = 1) in flat uint instanceIndex;
layout(location = 2) in flat uint firstTriangle;  // gl_PrimitiveID counts from it
layout(location = 3) in flat uint firstId;        // and so do ids

void main() {
  if (kMasked == 1 && isHole(materials[instances[instanceIndex].material], uv)) discard;
  DrawnFragment drawn;
  drawn.depth = gl_FragCoord.z;
  drawn.triangle = firstTriangle + gl_PrimitiveID;
  drawn.instance = instanceIndex;
  drawn.id = firstId + gl_PrimitiveID;
  storeChannels(drawn);
}
