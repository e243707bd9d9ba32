#pragma once
// How fast Embree itself answers the shadow rays of a picture: packets of sixteen (rtcOccluded16, robust), made in
// advance, without filters, on all cores. No exact shadow is traced faster here.

#include "truth/visibility.h"

#include <memory>

namespace gnomon {

class BareRays {
 public:
  // One ray a scored pixel, from the light to just before the surface. Every instance is copied to the world.
  BareRays(const Scene& scene, const LightModel& light, const Receivers& receivers);
  ~BareRays();

  double trace();           // wall clock, milliseconds
  size_t occluded() const;  // of the last tracing
  size_t count() const;     // rays

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon
