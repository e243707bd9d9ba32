#include "base/image.h"
#include "scene/scene.h"

namespace gnomon {

glm::vec4 baseColorAt(const Scene& scene, const Material& material, glm::vec2 uv) {
  if (material.baseColorTexture < 0) return material.baseColor;
  const glsl::TextureTaps taps = glsl::textureTaps(scene.textures[material.baseColorTexture], uv);
  glm::vec4 sum(0.0f);
  for (int i = 0; i < 4; ++i) {
    const glm::vec4 texel = glsl::unpackRgba8(scene.texels[taps.texel[i]]);
    const glm::vec4 linear(linearFromSrgb(texel.x), linearFromSrgb(texel.y), linearFromSrgb(texel.z), texel.w);
    sum += taps.weight[i] * linear;
  }
  return material.baseColor * sum;
}

}  // namespace gnomon
