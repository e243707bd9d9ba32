#pragma once
// A light as the ground truth and the maps model it.

#include "scene/scene.h"

namespace gnomon {

// A directional light's rays all run along directionW.
struct LightModel {
  LightType type = LightType::Point;
  glm::dvec3 positionW{0.0};        // point, spot
  glm::dvec3 directionW{0, -1, 0};  // unit; spot: the axis
  double outerConeRad = 0.0;        // spot: half angle; pixels outside are dark and not scored

  bool operator==(const LightModel&) const = default;
};

}  // namespace gnomon
