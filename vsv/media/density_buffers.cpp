#include "vsv/media/density_buffers.h"

#include "shared/media_pass.glsl"

#include <algorithm>
#include <cmath>

namespace gnomon {

glsl::LightReach lightReach(const Bounds& boundsW, double voxelMetres, const glm::dvec3& lightW) {
  const glm::dvec3 lower(boundsW.lower), upper(boundsW.upper), center = 0.5 * (lower + upper);
  const double nearest = glm::length(glm::max(glm::max(lower - lightW, lightW - upper), glm::dvec3(0.0)));
  const double farthest = glm::length(glm::max(glm::abs(lower - lightW), glm::abs(upper - lightW)));
  const double toCenter = glm::length(center - lightW);
  const glm::dvec3 axis = toCenter > 0.0 ? (center - lightW) / toCenter : glm::dvec3(0, 0, 1);
  double least = nearest > 0.0 ? 1.0 : -1.0;  // cosine of the cone that holds the bounds
  for (int corner = 0; corner < 8 && nearest > 0.0; ++corner) {
    const glm::dvec3 at((corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
                        (corner & 4) != 0 ? upper.z : lower.z);
    least = std::min(least, glm::dot(glm::normalize(at - lightW), axis));
  }
  // Half a texel more, so that what is looked up lies between texels.
  constexpr double kMargin = 1.0 + 1.0 / (glsl::kLightDepthSide - 1);
  const bool cone = least > 0.0;
  const double cell = (farthest - nearest) / (glsl::kLightDepthRadii - 1);
  return {.axisW = glm::vec3(axis),
          .halfWidth = static_cast<float>(kMargin * (cone ? std::sqrt(1.0 - least * least) / (1.0 + least) : 1.0)),
          .layers = cone ? 1 : 2,
          .near_ = static_cast<float>(nearest),
          .far_ = static_cast<float>(farthest),
          .substeps = static_cast<int>(std::clamp(std::ceil(cell / voxelMetres), 1.0, 4.0))};
}

}  // namespace gnomon
