// The picture for people: diffuse surfaces, one light with its visibility, a little ambient.
#include "shared/shade.glsl"

#include "scene/alpha_mask.glsl"
#include "scene/surface_fetch.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;

layout(scalar, binding = kBindUvs) readonly buffer Uvs { vec2 uvs[]; };
layout(scalar, binding = kBindNormals) readonly buffer Normals { vec3 normals[]; };
layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindVisibility) readonly buffer Visibility { float visibility[]; };
layout(scalar, binding = kBindRadiance) writeonly buffer Radiance { vec3 radiance[]; };

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

vec3 shadeSurface(ivec2 pixel, PrimitiveId id, float visible) {
  SurfacePoint surface = fetchSurface(shade.camera, pixel, id);
  SceneInstance instance = instances[id.instancePlusOne - 1u];
  SceneMaterial material = materials[instance.material];
  uvec3 v = triangles[id.triangle];
  vec3 b = surface.barycentric;
  vec3 albedo = material.baseColor.xyz;
  if (material.texture >= 0) {
    vec2 uv = uvs[v.x] * b.x + uvs[v.y] * b.y + uvs[v.z] * b.z;
    albedo *= textureColorAt(material.texture, uv);
  }
  // Interpolated normals for looks only; shadows know the triangle's own.
  vec3 normalM = normals[v.x] * b.x + normals[v.y] * b.y + normals[v.z] * b.z;
  vec3 normal = normalize(transpose(inverse(mat3(instance.worldFromMesh))) * normalM);
  vec3 toEye = normalize(shade.camera.eyeW - surface.position);
  if (dot(normal, toEye) < 0.0f && dot(surface.normal, toEye) * dot(surface.normal, normal) < 0.0f) normal = -normal;

  vec3 toLight = towardsLight(shade, surface.position);
  float distance2 = max(dot(toLight, toLight), 1e-12f);
  vec3 dir = toLight * inversesqrt(distance2);
  float falloff = shade.positional == 1.0f ? 1.0f / distance2 : 1.0f;
  float inCone = shade.coneCos <= -1.0f ? 1.0f : step(shade.coneCos, dot(-dir, shade.coneAxisW));
  vec3 direct = shade.lightColor * (max(dot(normal, dir), 0.0f) * falloff * visible * inCone);
  // A headlight's share keeps shapes readable in the shadow.
  vec3 ambient = shade.ambient * (0.6f + 0.4f * abs(dot(normal, toEye)));
  return albedo * (direct + ambient);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= shade.camera.width || pixel.y >= shade.camera.height) return;
  uint index = uint(pixel.y * shade.camera.width + pixel.x);
  PrimitiveId id = fetchPrimitive(pixel);
  float visible = visibility[index];
  vec3 color = vec3(0.0f);
  if (id.instancePlusOne != 0u)
    color = visible == kUnknownVisibility ? vec3(1.0f, 0.0f, 1.0f) : shadeSurface(pixel, id, visible);
  radiance[index] = color;
}
