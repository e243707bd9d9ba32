// A face of a cube map whose depth is linear in the distance from the light: the rasterizer knows how far along the
// face's axis a fragment lies (1 / gl_FragCoord.w), and the rest follows from where it is.
#include "shared/map.glsl"
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
  ShadowMap map = shadowMap;
  map.kind = kMapCubeRadial;
  vec2 mapUv = mapTexelCenter(map, ivec2(gl_FragCoord.xy));
  float m = 1.0f / gl_FragCoord.w;
  DrawnFragment drawn;
  // In the face's coordinates: a distance is the same in all of them.
  // What is nearer than the near end lies on it, as depth clamping has it.
  drawn.depth =
      max(cubeDepth(map, drawnSlice(), vec3(mapUv.x * 2.0f - 1.0f, mapUv.y * 2.0f - 1.0f, 1.0f) * m), 0.0f);
  drawn.triangle = firstTriangle + gl_PrimitiveID;
  drawn.instance = instanceIndex;
  drawn.id = firstId + gl_PrimitiveID;
  // Of a plane through the light itself, coordinates' rounding (2^-24 of the scene) says where it is met.
  if (!(m > map.sceneScale * 2.4e-7f)) discard;
  gl_FragDepth = drawn.depth;
  storeChannels(drawn);
}
