#pragma once
// The exact light that a medium scatters towards the camera: single scattering of point lights, visibility by
// Embree, everything else in double. The model is that of shaders/shared/medium.glsl, written out a second
// time on purpose: a reference that shared the shaders' functions could not find what is wrong with them.

#include "base/image.h"
#include "truth/tracer.h"

#include "shared/scene.glsl"

#include <span>
#include <vector>

namespace gnomon {

// What varies in a heterogeneous medium. Safe to ask from many threads.
class DensityField {
 public:
  virtual ~DensityField() = default;
  virtual double at(
      const glm::dvec3& posW) const = 0;  // a factor of sigmaS and sigmaA; >= 0; 0 outside of bounds
  virtual Bounds boundsW() const = 0;
  virtual double voxelMetres() const = 0;  // the finest detail there is
};

struct MediumModel {
  glm::dvec3 sigmaS{0.0}, sigmaA{0.0};    // 1/m; at density 1 where there is a density
  double g = 0.0;                         // mean cosine, in (-1, 1)
  double reach = 0.0;                     // metres from the eye: the end of rays that meet no surface before
  const DensityField* density = nullptr;  // none: homogeneous
};

struct MediaLight {
  glm::dvec3 positionW{0.0};
  glm::dvec3 intensity{1.0};  // candela, a colour channel each
};

}  // namespace gnomon
