#pragma once
// What a volume or a map for a medium is fitted to where the picture was traced.

#include "truth/receivers.h"

#include <vector>

namespace gnomon {

// Where the view rays of all pixels end, and the eye: what a volume or map for a medium is fitted to
// (FitInput::receiversW). `reach`: Medium::reach.
std::vector<glm::dvec3> mediaReceiversW(const glsl::CameraView& camera, const Receivers& receivers, double reach);

}  // namespace gnomon
