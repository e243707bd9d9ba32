#pragma once
// Whether a light stands where rounding decides what it lights.

#include "scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

// Where the surfaces of a scene are, roughly, so that of each light only those nearby are looked at. The scene must
// outlive it.
class LightPlaces {
 public:
  explicit LightPlaces(const Scene& scene);

  // The name of an instance with a triangle that passes through the light, within the rounding of coordinates (2^-21 of
  // the scene's diagonal): which side of it is dark no float can say. None for directional lights.
  std::optional<std::string> surfaceThrough(const Light& light) const;

 private:
  const Scene& scene_;
  std::vector<Bounds> meshBounds_;  // in mesh space
  double metres_ = 0.0;             // that rounding may be
};

}  // namespace gnomon
