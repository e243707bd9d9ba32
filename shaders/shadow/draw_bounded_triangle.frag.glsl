// The non-linear rasterizer: the ray through a texel's centre meets the triangle or does not. It knows the parameterization by mapTexelRay,
// mapHoldsTexelAt and mapDepth only; some compute shader has found a bound of the triangle's projection.
// kPass: 0 the first layer, 1 and 2 the second one, by blending and by peeling (src/shadow/map_image.h).
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_MAP_KIND kMapKind

#include "shared/ray_triangle.glsl"
#include "shared/shade.glsl"

#include "scene/alpha_mask.glsl"
#include "shadow/bounded_varyings.glsl"

layout(scalar, binding = kBindTriangles) readonly buffer Triangles { uvec3 triangles[]; };
layout(scalar, binding = kBindInstances) readonly buffer Instances { SceneInstance instances[]; };
layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };
layout(binding = kBindMapDepth) uniform texture2DArray mapDepthLayers;

layout(push_constant, scalar) uniform Push {
  int layer;
  float tolerance;  // of depth
};

layout(constant_id = 0) const int kMasked = 0;
layout(constant_id = 1) const int kPass = 0;

layout(location = 0) out float secondDepth;

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
  ivec2 texel = ivec2(gl_FragCoord.xy);
  // mapTexelCenter, which the rasterizer counts for us.
  Ray ray = mapTexelRay(map, layer, gl_FragCoord.xy / mapTexelCounts(map));
  vec3 distances = sideDistances(triangle, ray.dir);
  float along = 1.0f / dot(inverseNormal, ray.dir);
  float depth = mapDepth(map, layer, ray.dir * along);
  // As a near plane would: what is nearer than the near end is not in the map.
  if (!isWithin(distances) || !(depth >= 0.0f) || !mapHoldsTexelAt(map, gl_FragCoord.xy)) discard;
  if (kMasked == 1 && isHoleAt(distances)) discard;
  if (kPass == 2 && depth <= texelFetch(mapDepthLayers, ivec3(texel, layer), 0).x + tolerance) discard;
  gl_FragDepth = depth;
  secondDepth = depth;
}
