// An exported file beside Gnomon's own pass: each pixel's receiver is fetched as there, and its visibility asked of the
// exported function. The test fills in "tests/exported.glsl" and "tests/exported_map.glsl".
#include "shared/shade.glsl"

#include "scene/surface_fetch.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;
layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindVisibility) writeonly buffer Visibility { float visibility[]; };

#include "tests/exported.glsl"

#include "tests/exported_map.glsl"

uint triangleIdOf(PrimitiveId id) {
  if (kInstanced == 0) return id.triangle + 1u;
  SceneInstance instance = instances[id.instancePlusOne - 1u];
  return instance.firstId + (id.triangle - instance.firstTriangle);
}

// As shadow/receiver.glsl has it.
float visibilityOf(ivec2 pixel) {
  PrimitiveId id = fetchPrimitive(pixel);
  if (id.instancePlusOne == 0u) return 1.0f;
  SurfacePoint surface = fetchSurface(shade.camera, pixel, id);
  float lightSide = dot(surface.normal, towardsLight(shade, surface.position));
  float cameraSide = dot(surface.normal, shade.camera.eyeW - surface.position);
  if (!(lightSide * cameraSide > 0.0f)) return 0.0f;
  vec3 normal = lightSide > 0.0f ? surface.normal : -surface.normal;
  return exportedVisibility(surface.position, normal, triangleIdOf(id), pixel);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= shade.camera.width || pixel.y >= shade.camera.height) return;
  visibility[pixel.y * shade.camera.width + pixel.x] = visibilityOf(pixel);
}
