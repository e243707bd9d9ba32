// The headers of gnomon/glsl beside Gnomon's own pass: two maps in one shader, of which `source` says which is asked.
#include "shared/shade.glsl"

#include "scene/surface_fetch.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;
layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindVisibility) writeonly buffer Visibility { float visibility[]; };
layout(scalar, push_constant) uniform Push {
  int source;
  float endMargin;
};
layout(constant_id = 20) const int kMethod = 0;
layout(constant_id = 21) const int kFilter = 0;
layout(constant_id = 22) const int kTapCount = 1;
layout(constant_id = 23) const int kChannels = 1;
layout(binding = 19) uniform utextureBuffer meshRows;
layout(binding = 50) uniform texture2DArray lampDepths;
layout(binding = 51) uniform texture2DArray spotDepths;
layout(binding = 52) uniform utexture2DArray lampIds;
layout(binding = 53) uniform utexture2DArray spotIds;
layout(binding = 54) uniform texture2DArray lampSeconds;
layout(binding = 55) uniform texture2DArray spotSeconds;

#include "gnomon/glsl/map.glsl"
#include "gnomon/glsl/filter.glsl"
#include "gnomon/glsl/fetch.glsl"
#include "gnomon/glsl/bias.glsl"
#include "gnomon/glsl/surface_bias.glsl"
#include "gnomon/glsl/visibility.glsl"

float gnomonFetchDepth(int map, int slice, ivec2 texel) {
  ivec3 at = ivec3(texel, slice);
  return map == 0 ? texelFetch(lampDepths, at, 0).x : texelFetch(spotDepths, at, 0).x;
}
float gnomonFetchSecondDepth(int map, int slice, ivec2 texel) {
  ivec3 at = ivec3(texel, slice);
  return map == 0 ? texelFetch(lampSeconds, at, 0).x : texelFetch(spotSeconds, at, 0).x;
}
float gnomonFetchBackDepth(int map, int slice, ivec2 texel) { return 1.0f; }
uint gnomonFetchId(int map, int slice, ivec2 texel) {
  ivec3 at = ivec3(texel, slice);
  return map == 0 ? texelFetch(lampIds, at, 0).x : texelFetch(spotIds, at, 0).x;
}
uint gnomonFetchSecondId(int map, int slice, ivec2 texel) { return 0u; }
GnomonMapSlice gnomonMapSlice(int map, int slice) {
  return GnomonMapSlice(mapSlices[slice].clipFromLight, mapSlices[slice].lightFromClip);
}
GnomonMeshRow gnomonMeshRow(GnomonLookupTables tables, uint row) {
  uvec4 texel = texelFetch(meshRows, int(row));
  return GnomonMeshRow(uintBitsToFloat(texel.xyz), texel.w);
}
mat4 gnomonWorldFromMesh(GnomonLookupTables tables, uint instance) { return mat4(1.0f); }
GnomonIdChunk gnomonIdChunkAt(GnomonLookupTables tables, uint chunk) { return GnomonIdChunk(0u, 0u); }
GnomonTriangleFacts gnomonTriangleFacts(GnomonLookupTables tables, uint triangle) {
  return GnomonTriangleFacts(0u, 0u);
}
bool gnomonIsMeshHole(GnomonLookupTables tables, uint triangle, uint instance, vec3 weights) { return false; }

float visibilityOf(ivec2 pixel) {
  PrimitiveId id = fetchPrimitive(pixel);
  if (id.instancePlusOne == 0u) return 1.0f;
  SurfacePoint surface = fetchSurface(shade.camera, pixel, id);
  float lightSide = dot(surface.normal, towardsLight(shade, surface.position));
  float cameraSide = dot(surface.normal, shade.camera.eyeW - surface.position);
  if (!(lightSide * cameraSide > 0.0f)) return 0.0f;
  GnomonShadowMap map;
  map.kind = source == 0 ? kGnomonMapCube : kGnomonMapPlanar;
  map.sliceCount = source == 0 ? 6 : 1;
  map.width = shadowMap.width;
  map.height = shadowMap.height;
  map.sceneScale = shadowMap.sceneScale;
  map.zNear = shadowMap.zNear;
  map.zFar = shadowMap.zFar;
  map.clipDepth = shadowMap.clipDepth;
  map.positional = 1.0f;
  map.source = source;
  map.frame = GnomonLightFrame(lightFrame.originW, lightFrame.rightW, lightFrame.upW, lightFrame.backW);
  GnomonLookup lookup;
  lookup.method = kMethod;
  lookup.bias.knobs = shade.bias.knobs;
  lookup.bias.epsilonAt = shade.bias.epsilonAt;
  lookup.bias.priorityId = shade.bias.priorityId;
  lookup.channels = kChannels;
  lookup.filterKind = kFilter;
  lookup.tapCount = kTapCount;
  lookup.filterParams.knobs[0] = 4.0f;
  lookup.witnessReach = 2;
  lookup.endMargin = endMargin;
  lookup.instanced = 0;
  lookup.idShift = 0u;
  lookup.masked = 0;
  vec3 normal = lightSide > 0.0f ? surface.normal : -surface.normal;
  GnomonReceiver receiver = gnomonReceiverAt(map.frame, surface.position, normal, id.triangle + 1u);
  return gnomonVisibility(map, receiver, pixel, lookup);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= shade.camera.width || pixel.y >= shade.camera.height) return;
  visibility[pixel.y * shade.camera.width + pixel.x] = visibilityOf(pixel);
}
