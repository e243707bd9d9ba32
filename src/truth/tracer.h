#pragma once
// Exact visibility by Embree 3 (robust mode), with the decisions near a receiver redone in double precision.
//
// Every surface that casts (Instance::casts) blocks, from both sides. Holes of alpha masks are honoured with the same
// texture look-up as the shaders (shared/texture.glsl). Instances are Embree instances, so that nineteen million
// triangles fit.
//
// Embree decides in float which triangles a ray meets; everything about where it meets them is decided here
// in double. What that leaves: a silhouette seen from the light may lie aside by about 2^-23 of the ray's
// length (and, for instances, by as much of their distance from the world's origin).

#include "scene/scene.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <glm/glm.hpp>

namespace gnomon {

// A triangle of an instance, as the G-buffer names it.
struct Primitive {
  uint32_t instance = 0;
  uint32_t triangle = 0;
  bool operator==(const Primitive&) const = default;
};

// Where a pixel's ray meets its triangle.
struct SurfaceSample {
  glm::dvec3 positionW{0.0};  // on the primitive: barycentric weights clamped to the triangle
  glm::dvec3 normalW{0.0};    // unit, turned to the camera's side; where the pixel is scored, that is the light's, too
  Primitive primitive;
};

struct RayD {
  glm::dvec3 origin;  // W, metres
  glm::dvec3 dir;     // unit
};

struct SurfaceHit {
  double distance = 0.0;  // metres along the ray, recomputed in double from the primitive's corners
  Primitive primitive;
  glm::dvec3 normalW{0.0};  // unit, by the winding
};

// From a light to a receiver.
struct ShadowSegment {
  RayD ray;
  double distance = 0.0;        // metres to the receiver's point
  Primitive own;                // never blocks
  glm::dvec3 planeNormal{0.0};  // the receiver's, unit, turned to the light's side
};

class Tracer {
 public:
  // Builds the hierarchy; all cores. Throws WorldError where memory does not suffice. `scene` must outlive the tracer.
  explicit Tracer(const Scene& scene);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  const Scene& scene() const;
  const Bounds& boundsW() const;  // of the scene, metres

  // Nearest surface along the ray, or none.
  std::optional<SurfaceHit> firstHit(const RayD& ray) const;

  // Whether anything but `own` blocks the segment from ray.origin to the receiver at `distance`. A surface
  // blocks when the segment meets it more than `margin` metres, measured along `planeNormal` (the receiver's
  // unit normal, turned to the light's side), in front of the receiver's plane.
  bool occluded(const RayD& ray, double distance, const Primitive& own, const glm::dvec3& planeNormal,
                double margin) const;

  // What occluded() would say at every margin up to `enough`, from one traversal: how far in front of the
  // receiver's plane the highest blocker lies, in metres; of blockers higher than `enough` any one is
  // reported; -infinity where there is none. occluded() at a margin is: height > margin. Traced in packets of
  // kPacket: neighbours should be alike.
  static constexpr size_t kPacket = 16;
  void blockerHeights(std::span<const ShadowSegment> segments, double enough, std::span<double> heights) const;

  // The same from a light at a point to surfaces that face it, at most kPacket.
  void blockerHeights(const glm::dvec3& lightW, std::span<const SurfaceSample* const> receivers, double enough,
                      std::span<double> heights) const;

  // Whether a surface stands between a light and points in mid-air: one that a segment meets before its end,
  // as double has it. Writes 1 where one does. Traced in packets of kPacket: neighbours should be alike.
  void blockPoints(const glm::dvec3& lightW, std::span<const glm::dvec3> pointsW, std::span<uint8_t> blocked) const;

  // World positions of a triangle's corners in double, from the very floats the shaders read.
  void corners(const Primitive& primitive, glm::dvec3 out[3]) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon
