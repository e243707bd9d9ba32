// The second layer by depth peeling, as in Weiskopf & Ertl 2003, section 5: what equals the first layer, up to a tolerance, is
// thrown away, and an ordinary depth test keeps the nearest of the rest. kMasked leaves the holes of alpha masks open.
#include "shared/shade.glsl"

#include "scene/alpha_mask.glsl"
#include "shadow/drawn_layer.glsl"

layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };
layout(binding = kBindMapDepth) uniform texture2DArray mapDepthLayers;

layout(constant_id = 0) const int kMasked = 0;

layout(location = 0) in vec2 uv;
layout(location = 1) in flat uint instanceIndex;

layout(location = 0) out float depth;

void main() {
  if (kMasked == 1 && isHole(materials[instances[instanceIndex].material], uv)) discard;
  float first = texelFetch(mapDepthLayers, ivec3(ivec2(gl_FragCoord.xy), drawnLayer()), 0).x;
  if (gl_FragCoord.z <= first + tolerance) discard;
  depth = gl_FragCoord.z;
}
