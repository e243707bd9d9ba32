#include "lab/core/depth_images.h"

#include <limits>

namespace gnomon {

DepthImages depthInMetres(const gpu::Device& device, const Occluders& occluders) {
  const glsl::ShadowMap& shape = occluders.fitted().map;
  const bool positional = occluders.fitted().positional;
  const std::vector<float> first = occluders.downloadDepth(device), second = occluders.downloadSecondDepth(device);
  const ImageF nothing(shape.width * shape.sliceCount, shape.height, 1, std::numeric_limits<float>::infinity());
  DepthImages images{.first = nothing};
  if (!second.empty()) images.second = images.gap = nothing;
  for (int slice = 0; slice < shape.sliceCount; ++slice) {
    for (int y = 0; y < shape.height; ++y) {
      for (int x = 0; x < shape.width; ++x) {
        const size_t texel = (static_cast<size_t>(slice) * shape.height + y) * shape.width + x;
        const glsl::Ray ray = glsl::mapTexelRay(shape, slice, glsl::mapTexelCenter(shape, {x, y}));
        const auto along = [&](float depth) { return glsl::mapDistance(shape, slice, ray, depth); };
        const auto fromLight = [&](float depth) {
          const glm::vec3 posL = ray.origin + ray.dir * along(depth);
          return positional ? glm::length(posL) : -posL.z;
        };
        if (first[texel] < 1.0f) *images.first.at(slice * shape.width + x, y) = fromLight(first[texel]);
        if (second.empty() || second[texel] >= 1.0f) continue;
        *images.second->at(slice * shape.width + x, y) = fromLight(second[texel]);
        *images.gap->at(slice * shape.width + x, y) = along(second[texel]) - along(first[texel]);
      }
    }
  }
  return images;
}

}  // namespace gnomon
