#pragma once
// Whether a light stands where rounding decides what it lights.

#include "scene/scene.h"

#include <optional>
#include <string>

namespace gnomon {

// The name of an instance with a triangle that passes through the light, within the rounding of coordinates (2^-21 of
// the scene's diagonal): which side of it is dark no float can say. None for directional lights. O(triangles).
std::optional<std::string> surfaceThroughLight(const Scene& scene, const Light& light);

}  // namespace gnomon
