#pragma once
// Where a map's ids could not tell: of the pixels in shadow that a bias calls lit, those of which no texel near names a
// triangle that shadows them. No bias that asks these texels can know better from what they name; a walk over the mesh
// still may (docs/witness.md), where one of them names another triangle of the same surface.

#include "judge/scene_view.h"
#include "shadow/parameterization.h"
#include "truth/labels.h"

#include <cstdint>
#include <span>

namespace gnomon {

struct MapIds {
  const FittedMap& fitted;
  std::span<const uint32_t> ids;  // of the texels, slice after slice
  int reach = 2;                  // texels a side, around the pixel's point, as `witness` asks them: 2 or 4
};

// Fills in LabelImage::unseen of an image that labelPixels() made. What stands before a pixel is what its exact ray
// meets, one after the other, before the receiver's plane.
void findUnseenOccluders(LabelImage& image, const SceneView& view, const LightModel& light, const Receivers& receivers,
                         const Truth& truth, const MapIds& map);

}  // namespace gnomon
