#pragma once
// Tests on the device itself whether one multiview pass draws all slices of a projective map correctly, and whether it
// is faster than one pass a slice: lavapipe 22.3.6 sends triangles to the wrong slices (gpu::RenderTargets::viewMask).

#include "scene/scene_buffers.h"
#include "shadow/parameterization.h"

#include <functional>

namespace gnomon {

class MapImage;

struct MultiviewCheck {
  bool same = false;    // every texel of every slice, to the bit
  bool faster = false;  // measured only where they are the same
};

// Draws triangles all around the light, few and large ones that cross the slices' borders first, then, where
// these are right, many small ones, whose times are compared. `draw` draws them into the map and gives its
// wall clock in milliseconds.
using DrawSlices = std::function<double(const SceneBuffers& scene, MapImage& map, bool multiview)>;
MultiviewCheck checkMultiview(const gpu::Device& device, const FittedMap& fitted, const DrawSlices& draw);

}  // namespace gnomon
