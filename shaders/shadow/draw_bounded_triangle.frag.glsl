// The non-linear rasterizer: one ray-triangle test a texel. It uses only mapTexelRay, mapHoldsTexelAt and mapDepth of
// the parameterization; a compute shader has bounded the triangle's projection before.
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_MAP_KIND kMapKind

#include "shared/map.glsl"
#include "shared/ray_triangle.glsl"
#include "shared/scene.glsl"

#include "scene/alpha_mask.glsl"
#include "shadow/bounded_varyings.glsl"
#include "shadow/store_channels.glsl"

layout(scalar, binding = kBindTriangles) readonly buffer Triangles { uvec3 triangles[]; };
layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };
layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };

layout(constant_id = 0) const int kMasked = 0;

bool isHoleAt(vec3 distances) {
  vec3 weight = distances * (1.0f / (distances.x + distances.y + distances.z));
  uvec3 v = triangles[triangleAndInstance.x];
  vec2 uv = uvs[v.x] * weight.x + uvs[v.y] * weight.y + uvs[v.z] * weight.z;
  return isHole(materials[instances[triangleAndInstance.y].material], uv);
}

void main() {
  ShadowMap map = shadowMap;
  LightTriangle triangle;
  triangle.sideA = sideA;
  triangle.sideB = sideB;
  triangle.sideC = sideC;
  // mapTexelCenter, which the rasterizer counts for us.
  Ray ray = mapTexelRay(map, slice, gl_FragCoord.xy / mapTexelCounts(map));
  vec3 distances = sideDistances(triangle, ray.dir);
  float along = 1.0f / dot(inverseNormal, ray.dir);
  DrawnFragment drawn;
  // What is nearer than the near end lies on it, as depth clamping has it.
  drawn.depth = max(mapDepth(map, slice, ray.dir * along), 0.0f);
  drawn.triangle = triangleAndInstance.x;
  drawn.instance = triangleAndInstance.y;
  drawn.id = triangleId;
  // Of a plane through the light itself, coordinates' rounding (2^-24 of the scene) says where it is met.
  bool ahead = along > map.sceneScale * 2.4e-7f;
  if (!isWithin(distances) || !ahead || !mapHoldsTexelAt(map, gl_FragCoord.xy)) discard;
  if (kMasked == 1 && isHoleAt(distances)) discard;
  gl_FragDepth = drawn.depth;
  storeChannels(drawn);
}
