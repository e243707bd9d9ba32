#pragma once
// The receivers, in double precision: for each pixel the point where its ray meets the primitive in the G-buffer, and
// whether the pixel is scored for a light.

#include "scene/light_model.h"
#include "scene/scene.h"
#include "truth/per_pixel.h"
#include "truth/tracer.h"

#include "shared/scene.glsl"

#include <span>
#include <vector>

namespace gnomon {

enum class PixelState : uint8_t {
  Empty,        // no surface
  FacingAway,   // the light is on the other side of the surface from the camera (or exactly in its plane)
  OutsideCone,  // a spot light does not reach it
  Scored,
};

struct SurfaceSample {
  glm::dvec3 positionW{0.0};  // on the primitive: barycentric weights clamped to the triangle
  glm::dvec3 normalW{0.0};    // unit, turned to the light's side
  Primitive primitive;
};

struct Receivers {
  int width = 0;
  int height = 0;
  std::vector<PixelState> states;   // one a pixel, rows from the top
  PerPixel<SurfaceSample> samples;  // one a pixel; meaningless where Empty
  size_t scored = 0;
  size_t facingAway = 0;
  size_t outsideCone = 0;
};

// shared/scene.glsl's pixelDirection in double, from the same floats; unit, from the eye.
RayD pixelRay(const glsl::CameraView& camera, int x, int y);

// `ids`: width*height G-buffer pixels. All cores.
Receivers computeReceivers(const Tracer& tracer, const glsl::CameraView& camera, const LightModel& light,
                           std::span<const glsl::PrimitiveId> ids);

}  // namespace gnomon
