#pragma once
// The reference for participating media: single scattering of point lights, with visibility by Embree and everything
// else in double precision. The model is that of shaders/shared/medium.glsl, deliberately implemented a second time: a
// reference that shared the shaders' functions could not find their errors.

#include "base/image.h"
#include "truth/receivers.h"

#include "shared/scene.glsl"

#include <span>
#include <vector>

namespace gnomon {

// What varies in a heterogeneous medium. Safe to ask from many threads.
class DensityField {
 public:
  virtual ~DensityField() = default;
  virtual double at(const glm::dvec3& posW) const = 0;  // a factor of sigmaS and sigmaA; >= 0; 0 outside of bounds
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
  glm::dvec3 intensity{1.0};   // candela, a colour channel each
  glm::dvec3 axisW{0, -1, 0};  // unit; a spot's
  double cosCone = -1.0;       // of the half angle: nothing outside of it is lit; -1: a point light
};

struct MediaReferenceOptions {
  double bound = 1e-3;     // of the picture's mean: what doubling a pixel's samples may still change it by
  int firstSamples = 256;  // of visibility, a view ray and light; at least 1
  int mostDoublings = 7;   // at least 2
};

struct MediaReference {
  ImageF inScattered;        // rgb, cd/m^2
  double mean = 0.0;         // over pixels and channels
  double bound = 0.0;        // as asked for
  double worstChange = 0.0;  // what the last doubling (or halving of steps) changed any channel by, of the mean
  size_t atLimit = 0;        // pixels that the last doubling allowed changed by more than the bound
  int doublings = 0;         // the most of any pixel
  uint64_t rays = 0;         // towards lights
  double ms = 0.0;
};

// Metres from the eye to the surface a pixel sees, or to `reach` where that is nearer or there is none.
std::vector<double> viewRayEnds(const glsl::CameraView& camera, const Receivers& receivers, double reach);

// `ends`: a view ray's length in metres, one a pixel. Visibility is sampled at stratified points, jittered, along phi,
// the angle at the light (equiangular sampling: Kulla and Fajardo, "Importance Sampling Techniques for Path Tracing in
// Participating Media", EGSR 2012), and bisected between neighbours that differ. A tile's samples are doubled until two
// doublings in a row change none of its pixels by more than the bound: one alone is easily quiet because both passed a
// thin shaft by. Steps through a density are halved, too, until that changes none by more. Uses all cores; the result
// does not depend on their number. Shows progress. Throws Interrupted.
MediaReference computeMediaReference(const Tracer& tracer, std::span<const MediaLight> lights,
                                     const glsl::CameraView& camera, std::span<const double> ends,
                                     const MediumModel& medium, const MediaReferenceOptions& options = {});

}  // namespace gnomon
