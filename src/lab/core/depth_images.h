#pragma once
// What a drawn map stores, in metres.

#include "lab/core/session.h"

#include <optional>

namespace gnomon {

// Metres from the light (its plane, when directional) to what the map stores, layers side by side; infinity
// where it stores nothing. Both layers of a two-layer map, and their distance along the texel's ray.
struct DepthImages {
  ImageF first;
  std::optional<ImageF> second, gap;
};
DepthImages depthInMetres(const Session& session, const DrawnMap& map);

}  // namespace gnomon
