// The nearest occluder of each column of a shadow volume (shared/volume_source.glsl), from the columns' own
// map or from another one.
#include "shared/shade.glsl"
#include "shared/volume.glsl"
#include "shared/volume_source.glsl"

layout(local_size_x = kColumnGroupSide, local_size_y = kColumnGroupSide) in;

layout(constant_id = 0) const int kSourceKind = kMapEpipolar;

// As MapUniforms, of the other map; it has no matrices to read.
layout(scalar, binding = kBindSourceMap) uniform SourceUniforms {
  LightFrame sourceFrame;
  ShadowMap sourceMap;
};
layout(binding = kBindMapDepth) uniform texture2DArray mapDepthSlices;
layout(scalar, binding = kBindOccluders) writeonly buffer Occluders { float occluders[]; };

float lookedUp(vec3 dirL) {
  ShadowMap map = sourceMap;
  map.kind = kSourceKind;
  vec3 dirS = sourceDirection(lightFrame, sourceFrame, dirL);
  MapPoint point = mapProject(map, dirS);
  float depth = texelFetch(mapDepthSlices, ivec3(mapTexel(map, point.uv), point.slice), 0).x;
  return alphaLookedUp(map, point, depth, dirS, dirL, shadowMap.epipolar.eyeDistance);
}

float drawn(ivec2 column) { return alphaDrawn(shadowMap.epipolar, texelFetch(mapDepthSlices, ivec3(column, 0), 0).x); }

void main() {
  ivec2 column = ivec2(gl_GlobalInvocationID.xy);
  ShadowMap map = shadowMap;
  map.kind = kMapEpipolar;
  if (column.x >= map.width || column.y >= map.height) return;
  float alpha = kSourceKind == kMapEpipolar ? drawn(column)
                                            : lookedUp(mapTexelRay(map, 0, mapTexelCenter(map, column)).dir);
  occluders[column.y * map.width + column.x] = alpha;
}
