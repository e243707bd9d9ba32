// The functions of shared/lookup_tables.glsl in a shader. To be included before shared/surface_bias.glsl, after
// scene/surface_fetch.glsl (instances, triangles) and shadow/fetch_channels.glsl (ids, depths).
#ifndef GNOMON_FETCH_LOOKUP_TABLES_GLSL
#define GNOMON_FETCH_LOOKUP_TABLES_GLSL

#define GNOMON_LOOKUP_TABLES
#include "shared/lookup_tables.glsl"

#include "scene/alpha_mask.glsl"

layout(binding = kBindMeshRows) uniform utextureBuffer meshRows;
layout(scalar, binding = kBindIdChunks) readonly buffer IdChunks { IdChunk idChunks[]; };
layout(scalar, binding = kBindTriangleFacts) readonly buffer Facts { TriangleFacts facts[]; };
layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };

MeshRow meshRow(LookupTables tables, uint row) {
  uvec4 texel = texelFetch(meshRows, int(row));
  return MeshRow(uintBitsToFloat(texel.xyz), texel.w);
}
mat4 worldFromMesh(LookupTables tables, uint instance) { return instances[instance].worldFromMesh; }
IdChunk idChunkAt(LookupTables tables, uint chunk) { return idChunks[chunk]; }
TriangleFacts triangleFacts(LookupTables tables, uint triangle) { return facts[triangle]; }
bool isMeshHole(LookupTables tables, uint triangle, uint instance, vec3 weights) {
  SceneMaterial material = materials[instances[kInstanced == 1 ? instance : facts[triangle].instance].material];
  if (material.alphaMask == 0) return false;
  uvec3 v = triangles[triangle];
  return isHole(material, uvs[v.x] * weights.x + uvs[v.y] * weights.y + uvs[v.z] * weights.z);
}
uint mapIdAt(LookupTables tables, int slice, ivec2 texel) { return texelFetch(idSlices, ivec3(texel, slice), 0).x; }
uvec4 mapIdsAround(LookupTables tables, int slice, ivec2 first) {
  vec2 corner = vec2(float(first.x + 1) / float(tables.mapWidth), float(first.y + 1) / float(tables.mapHeight));
  return textureGather(idSlices, vec3(corner, float(slice))).wzxy;
}
float mapDepthAt(LookupTables tables, int slice, ivec2 texel) {
  return texelFetch(depthSlices, ivec3(texel, slice), 0).x;
}

#endif
