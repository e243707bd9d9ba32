// The light that the surface of a G-buffer's pixel sends to the eye. The including shader declares `shade`.
#ifndef GNOMON_SURFACE_RADIANCE_GLSL
#define GNOMON_SURFACE_RADIANCE_GLSL

#include "scene/surface_fetch.glsl"
#include "shadow/surface_light.glsl"

layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };
layout(scalar, binding = kBindNormals) readonly buffer Normals { vec3 normals[]; };

SurfaceLight shadeSurface(ivec2 pixel, PrimitiveId id, float visible, out vec3 position) {
  SurfacePoint surface = fetchSurface(shade.camera, pixel, id);
  SceneInstance instance = instances[id.instancePlusOne - 1u];
  SceneMaterial material = materials[instance.material];
  uvec3 v = triangles[id.triangle];
  vec3 b = surface.barycentric;
  vec3 albedo = material.baseColor.xyz;
  if (kTextured == 1 && material.texture >= 0) {
    vec2 uv = uvs[v.x] * b.x + uvs[v.y] * b.y + uvs[v.z] * b.z;
    albedo *= textureColorAt(material.texture, uv);
  }
  vec3 normal = normals[v.x] * b.x + normals[v.y] * b.y + normals[v.z] * b.z;
  if (kInstanced == 1) normal = transpose(inverse(mat3(instance.worldFromMesh))) * normal;
  SurfaceView seen;
  seen.planeNormal = surface.normal;
  seen.smoothNormal = normal;
  seen.toEye = shade.camera.eyeW - surface.position;
  seen.toLight = towardsLight(shade, surface.position);
  seen.coneAxis = shade.coneAxisW;
  position = surface.position;
  return lightSurface(seen, albedo, visible);
}

#endif
