// The light that a diffuse surface sends to the eye: of one light with its visibility, and a little ambient. The
// including shader declares `shade`.
#ifndef GNOMON_SURFACE_LIGHT_GLSL
#define GNOMON_SURFACE_LIGHT_GLSL

#include "shared/shade.glsl"

#include "scene/alpha_mask.glsl"

// 0: no material has a texture. lavapipe runs a branch that no pixel takes as if all did, and this one is a third of
// the radiance pass: twelve powers and what they are of.
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
  vec3 albedo;
  vec3 direct;    // of the light
  vec3 ambient;
};

// What a point of a surface knows of it; vectors of any length but coneAxis, all in one frame.
struct SurfaceView {
  vec3 planeNormal;
  vec3 smoothNormal;  // interpolated, for looks only, since shadows know the triangle's own; zero: the triangle's own
  vec3 toEye;
  vec3 toLight;       // its length counts where the light is positional
  vec3 coneAxis;
};

// Squared lengths instead of unit vectors: two roots and a quotient in all.
SurfaceLight lightSurface(SurfaceView seen, vec3 albedo, float visible) {
  vec3 normal = seen.smoothNormal == vec3(0.0f) ? seen.planeNormal : seen.smoothNormal;
  float toEye = dot(normal, seen.toEye);
  float toLight = dot(normal, seen.toLight);
  // Turned to the eye's side, as the triangle is; where the two disagree about the side, it stays.
  if (toEye < 0.0f && dot(seen.planeNormal, seen.toEye) * dot(seen.planeNormal, normal) < 0.0f) toLight = -toLight;

  float normal2 = max(dot(normal, normal), 1e-12f);
  float distance2 = max(dot(seen.toLight, seen.toLight), 1e-12f);
  float falloff = shade.positional == 1.0f ? 1.0f / distance2 : 1.0f;
  float inCone = 1.0f;
  if (shade.coneCos > -1.0f) inCone = step(shade.coneCos, dot(-seen.toLight, seen.coneAxis) * inversesqrt(distance2));
  float facing = max(toLight, 0.0f) * inversesqrt(normal2 * distance2);
  SurfaceLight light;
  light.albedo = albedo;
  light.direct = shade.lightColor * (facing * falloff * visible * inCone);
  // A headlight's share keeps shapes readable in the shadow.
  float eyeDistance2 = max(dot(seen.toEye, seen.toEye), 1e-12f);
  light.ambient = shade.ambient * (0.6f + 0.4f * abs(toEye) * inversesqrt(normal2 * eyeDistance2));
  return light;
}

vec3 seenColor(SurfaceLight light, float visible) {
  return visible == kUnknownVisibility ? vec3(1.0f, 0.0f, 1.0f) : light.albedo * (light.direct + light.ambient);
}

#endif
