#pragma once
// The receivers, in double precision: for each pixel the point where its ray meets the primitive in the G-buffer, and
// whether the pixel is scored for a light.

#include "scene/light_model.h"
#include "scene/scene.h"
#include "truth/per_pixel.h"
#include "truth/tracer.h"

#include "shared/scene.glsl"

#include <memory>
#include <span>
#include <vector>

namespace gnomon {

enum class PixelState : uint8_t {
  Empty,        // no surface
  FacingAway,   // the light is on the other side of the surface from the camera (or exactly in its plane)
  OutsideCone,  // a spot light does not reach it
  Scored,
};

// One a pixel, meaningless where there is no surface. Copies share them: they depend on the camera, not on the light.
class SurfaceSamples {
 public:
  SurfaceSamples() = default;
  explicit SurfaceSamples(PerPixel<SurfaceSample> samples)
      : owned_(std::make_shared<const PerPixel<SurfaceSample>>(std::move(samples))), seen_(*owned_) {}

  size_t size() const { return seen_.size(); }
  const SurfaceSample& operator[](size_t pixel) const { return seen_[pixel]; }
  auto begin() const { return seen_.begin(); }
  auto end() const { return seen_.end(); }

 private:
  std::shared_ptr<const PerPixel<SurfaceSample>> owned_;
  std::span<const SurfaceSample> seen_;
};

struct Receivers {
  int width = 0;
  int height = 0;
  std::vector<PixelState> states;  // one a pixel, rows from the top
  SurfaceSamples samples;
  size_t scored = 0;
  size_t facingAway = 0;
  size_t outsideCone = 0;
};

// shared/scene.glsl's pixelDirection in double, from the same floats; unit, from the eye.
RayD pixelRay(const glsl::CameraView& camera, int x, int y);

// `ids`: width*height G-buffer pixels. All cores.
SurfaceSamples computeSurfaces(const Tracer& tracer, const glsl::CameraView& camera,
                               std::span<const glsl::PrimitiveId> ids);
// Of these surfaces, or of those that it computes first.
Receivers computeReceivers(const Tracer& tracer, const glsl::CameraView& camera, const LightModel& light,
                           std::span<const glsl::PrimitiveId> ids, const SurfaceSamples& surfaces);
Receivers computeReceivers(const Tracer& tracer, const glsl::CameraView& camera, const LightModel& light,
                           std::span<const glsl::PrimitiveId> ids);

}  // namespace gnomon
