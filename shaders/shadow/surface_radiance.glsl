// The light that a diffuse surface sends to the eye: of one light with its visibility, and a little ambient. The
// including shader declares `shade`.
#ifndef GNOMON_SURFACE_RADIANCE_GLSL
#define GNOMON_SURFACE_RADIANCE_GLSL

#include "shared/shade.glsl"

#include "scene/alpha_mask.glsl"
#include "scene/surface_fetch.glsl"

layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };
layout(scalar, binding = kBindNormals) readonly buffer Normals { vec3 normals[]; };

// 0: no material of the scene has a texture. lavapipe runs a branch that no pixel takes as if all did, and this one is
// a third of the pass: twelve powers and what they are of.
layout(constant_id = 8) const int kTextured = 1;

vec3 linearFromSrgb(vec3 c) {
  return mix(c * (1.0f / 12.92f), pow((c + 0.055f) * (1.0f / 1.055f), vec3(2.4f)), greaterThan(c, vec3(0.04045f)));
}

// Linear colour: each texel is decoded before it is weighted.
vec3 textureColorAt(int textureIndex, vec2 uv) {
  TextureTaps taps = textureTaps(textures[textureIndex], uv);
  vec3 sum = vec3(0.0f);
  for (int i = 0; i < 4; ++i) sum += linearFromSrgb(unpackRgba8(texels[taps.texel[i]]).xyz) * taps.weight[i];
  return sum;
}

// What a surface sends to the eye: albedo times the sum.
struct SurfaceLight {
  vec3 position;  // of the surface
  vec3 albedo;
  vec3 direct;    // of the light
  vec3 ambient;
};

SurfaceLight shadeSurface(ivec2 pixel, PrimitiveId id, float visible) {
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
  // Interpolated normals for looks only; shadows know the triangle's own.
  vec3 normalM = normals[v.x] * b.x + normals[v.y] * b.y + normals[v.z] * b.z;
  if (kInstanced == 1) normalM = transpose(inverse(mat3(instance.worldFromMesh))) * normalM;
  vec3 normal = normalize(normalM);
  vec3 toEye = normalize(shade.camera.eyeW - surface.position);
  if (dot(normal, toEye) < 0.0f && dot(surface.normal, toEye) * dot(surface.normal, normal) < 0.0f) normal = -normal;

  vec3 toLight = towardsLight(shade, surface.position);
  float distance2 = max(dot(toLight, toLight), 1e-12f);
  vec3 dir = toLight * inversesqrt(distance2);
  float falloff = shade.positional == 1.0f ? 1.0f / distance2 : 1.0f;
  float inCone = shade.coneCos <= -1.0f ? 1.0f : step(shade.coneCos, dot(-dir, shade.coneAxisW));
  SurfaceLight light;
  light.position = surface.position;
  light.albedo = albedo;
  light.direct = shade.lightColor * (max(dot(normal, dir), 0.0f) * falloff * visible * inCone);
  // A headlight's share keeps shapes readable in the shadow.
  light.ambient = shade.ambient * (0.6f + 0.4f * abs(dot(normal, toEye)));
  return light;
}

#endif
