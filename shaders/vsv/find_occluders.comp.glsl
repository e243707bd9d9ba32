// The nearest occluder of each column of a shadow volume, as alpha: from the columns' own map, where each column's ray has met the scene
// itself, or by looking the ray up in another map of the same light. There it is hidden from where the map's depth along the ray is what
// the texel stores: the very answer of that map, without bias, for every point of the column.
#include "shared/shade.glsl"
#include "shared/volume.glsl"

layout(local_size_x = kColumnGroupSide, local_size_y = kColumnGroupSide) in;

layout(constant_id = 0) const int kSourceKind = kMapEpipolar;

// As MapUniforms, of the other map; it has no matrices to read.
layout(scalar, binding = kBindSourceMap) uniform SourceUniforms {
  LightFrame sourceFrame;
  ShadowMap sourceMap;
};
layout(binding = kBindMapDepth) uniform texture2DArray mapDepthLayers;
layout(scalar, binding = kBindOccluders) writeonly buffer Occluders { float occluders[]; };

float lookedUp(Ray ray) {
  ShadowMap map = sourceMap;
  map.kind = kSourceKind;
  vec3 dirW = lightFrame.rightW * ray.dir.x + lightFrame.upW * ray.dir.y + lightFrame.backW * ray.dir.z;
  vec3 dirS = directionFromWorld(sourceFrame, dirW);
  MapPoint point = mapProject(map, dirS);
  float depth = texelFetch(mapDepthLayers, ivec3(mapTexel(map, point.uv), point.layer), 0).x;
  if (!point.covered || depth >= 1.0f) return uintBitsToFloat(0x7f800000u);
  Ray raySource = mapTexelRay(map, point.layer, point.uv);
  float along = mapDistance(map, point.layer, raySource, depth) + dot(raySource.origin, dirS);
  return epipolarFromLight(shadowMap.epipolar.eyeDistance, ray.dir * along).alpha;
}

float drawn(ivec2 column) {
  float depth = texelFetch(mapDepthLayers, ivec3(column, 0), 0).x;
  return depth < 1.0f ? depth * alphaUpper(shadowMap.epipolar) : uintBitsToFloat(0x7f800000u);
}

void main() {
  ivec2 column = ivec2(gl_GlobalInvocationID.xy);
  ShadowMap map = shadowMap;
  map.kind = kMapEpipolar;
  if (column.x >= map.side || column.y >= map.rows) return;
  float alpha = kSourceKind == kMapEpipolar ? drawn(column) : lookedUp(mapTexelRay(map, 0, mapTexelCenter(map, column)));
  occluders[column.y * map.side + column.x] = alpha;
}
