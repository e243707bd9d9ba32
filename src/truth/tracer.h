#pragma once
// Exact visibility by Embree 3 (robust mode), with the decisions near a receiver redone in double precision.
//
// Every surface blocks from both sides. Holes of alpha masks are honoured with the same texture look-up as the shaders
// (shared/texture.glsl). Instances are Embree instances, so that nineteen million triangles fit.

#include "scene/scene.h"

#include <cstdint>
#include <memory>
#include <optional>

#include <glm/glm.hpp>

namespace gnomon {

// A triangle of an instance, as the G-buffer names it.
struct Primitive {
  uint32_t instance = 0;
  uint32_t triangle = 0;
  bool operator==(const Primitive&) const = default;
};

struct RayD {
  glm::dvec3 origin;  // W, metres
  glm::dvec3 dir;     // unit
};

struct SurfaceHit {
  double distance = 0.0;  // metres along the ray, recomputed in double from the primitive's corners
  Primitive primitive;
  glm::dvec3 normalW;     // unit, by the winding
};

class Tracer {
 public:
  // Builds the hierarchy; all cores. Throws WorldError where memory does not suffice. `scene` must outlive the tracer.
  explicit Tracer(const Scene& scene);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  const Scene& scene() const;

  // Nearest surface along the ray, or none.
  std::optional<SurfaceHit> firstHit(const RayD& ray) const;

  // Whether anything but `own` blocks the segment from ray.origin to the receiver at `distance`. A surface blocks when
  // the ray meets it more than `margin` metres, measured along `planeNormal` (the receiver's unit normal), in front of
  // the receiver's plane. Hits within a thousandth of the distance of the receiver are decided in double.
  bool occluded(const RayD& ray, double distance, const Primitive& own, const glm::dvec3& planeNormal,
                double margin) const;

  // World positions of a triangle's corners in double, from the very floats the shaders read.
  void corners(const Primitive& primitive, glm::dvec3 out[3]) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon
