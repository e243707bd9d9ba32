// A face of a cube map whose depth is linear in the distance from the light: the rasterizer knows how far along the face's axis
// a fragment lies (1 / gl_FragCoord.w), and the rest follows from where it is. kPass: 0 the first layer, 1 and 2 the second one, by blending
// and by peeling (src/shadow/map_image.h).
#include "shared/shade.glsl"

#include "scene/alpha_mask.glsl"
#include "shadow/drawn_layer.glsl"

layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };
layout(binding = kBindMapDepth) uniform texture2DArray mapDepthLayers;

layout(constant_id = 0) const int kMasked = 0;
layout(constant_id = 1) const int kPass = 0;

layout(location = 0) in vec2 uv;
layout(location = 1) in flat uint instanceIndex;

layout(location = 0) out float secondDepth;

void main() {
  if (kMasked == 1 && isHole(materials[instances[instanceIndex].material], uv)) discard;
  ShadowMap map = shadowMap;
  map.kind = kMapCubeRadial;
  vec2 mapUv = mapTexelCenter(map, ivec2(gl_FragCoord.xy));
  float m = 1.0f / gl_FragCoord.w;
  // In the face's coordinates: a distance is the same in all of them.
  float depth = cubeDepth(map, drawnLayer(), vec3(mapUv.x * 2.0f - 1.0f, mapUv.y * 2.0f - 1.0f, 1.0f) * m);
  // As a near plane would: what is nearer than the near end is not in the map.
  if (depth < 0.0f) discard;
  if (kPass == 2 && depth <= texelFetch(mapDepthLayers, ivec3(ivec2(gl_FragCoord.xy), drawnLayer()), 0).x + tolerance) discard;
  gl_FragDepth = depth;
  secondDepth = depth;
}
