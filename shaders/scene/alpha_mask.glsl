// Whether an alpha mask has a hole at uv: the factor and the texture's alpha against the material's cutoff.
// The fetch is textureTaps', the very one the ray tracer makes (Scene::baseColorAt).
#ifndef GNOMON_ALPHA_MASK_GLSL
#define GNOMON_ALPHA_MASK_GLSL

#include "shared/scene.glsl"

layout(scalar, binding = kBindMaterials) readonly buffer Materials { SceneMaterial materials[]; };
layout(scalar, binding = kBindTextures) readonly buffer Textures { TextureInfo textures[]; };
layout(scalar, binding = kBindTexels) readonly buffer Texels { uint texels[]; };

// sRGB colour and linear alpha.
vec4 textureAt(int textureIndex, vec2 uv) {
  TextureTaps taps = textureTaps(textures[textureIndex], uv);
  vec4 sum = vec4(0.0f);
  for (int i = 0; i < 4; ++i) sum += unpackRgba8(texels[taps.texel[i]]) * taps.weight[i];
  return sum;
}

bool isHole(SceneMaterial material, vec2 uv) {
  float alpha = material.baseColor.w;
  if (material.texture >= 0) alpha *= textureAt(material.texture, uv).w;
  return alpha < material.alphaCutoff;
}

#endif
