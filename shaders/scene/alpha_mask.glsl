// Whether an alpha mask has a hole at uv: the factor and the texture's alpha against the material's cutoff.
// The fetch is textureTaps', the very one the ray tracer makes (Scene::baseColorAt).
#ifndef GNOMON_ALPHA_MASK_GLSL
#define GNOMON_ALPHA_MASK_GLSL

#include "shared/scene.glsl"

layout(scalar, binding = kBindMaterials) readonly buffer Materials { SceneMaterial materials[]; };
layout(scalar, binding = kBindTextures) readonly buffer Textures { TextureInfo textures[]; };
layout(scalar, binding = kBindTexels) readonly buffer Texels { uint texels[]; };

float textureAlphaAt(int textureIndex, vec2 uv) {
  TextureTaps taps = textureTaps(textures[textureIndex], uv);
  float sum = 0.0f;
  for (int i = 0; i < 4; ++i) sum += unpackRgba8(texels[taps.texel[i]]).w * taps.weight[i];
  return sum;
}

bool isHole(SceneMaterial material, vec2 uv) {
  float alpha = material.baseColor.w;
  if (material.texture >= 0) alpha *= textureAlphaAt(material.texture, uv);
  return alpha < material.alphaCutoff;
}

#endif
