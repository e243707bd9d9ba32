#pragma once
// The depths that a rendered map or volume stores, converted to metres.

#include "base/image.h"
#include "shadow/occluders.h"

#include <optional>

namespace gnomon {

// Metres from the light (its plane, when directional) to what the map stores, slices side by side; infinity
// where it stores nothing. Both layers of a two-layer map, and their distance along the texel's ray.
struct DepthImages {
  ImageF first;
  std::optional<ImageF> second, gap;
};
DepthImages depthInMetres(const gpu::Device& device, const Occluders& occluders);

}  // namespace gnomon
