#pragma once
// Tests on the device itself whether one multiview pass draws all layers of a projective map correctly, and whether it
// is faster than one pass a layer: lavapipe 22.3.6 sends triangles to the wrong layers (gpu::RenderTargets::viewMask).

#include "scene/scene_buffers.h"
#include "shadow/parameterization.h"

#include <functional>

namespace gnomon {

class MapImage;

struct MultiviewCheck {
  bool same = false;    // every texel of every layer, to the bit
  bool faster = false;  // measured only where they are the same
};

// Draws triangles all around the light, few and large ones that cross the layers' borders first, then, where
// these are right, many small ones, whose times are compared. `draw` draws them into the map and gives its
// wall clock in milliseconds.
using DrawLayers = std::function<double(const SceneBuffers& scene, MapImage& map, bool multiview)>;
MultiviewCheck checkMultiview(const gpu::Device& device, const FittedMap& fitted, const DrawLayers& draw);

}  // namespace gnomon
