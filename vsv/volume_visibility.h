#pragma once
// Pixels to light or shadow by a shadow volume. Reads and writes the buffers of a VisibilityPass, so that
// whatever reads those serves maps and volumes alike.

#include "shadow/visibility_pass.h"
#include "vsv/shadow_volume.h"

namespace gnomon {

// Whether a bias means anything on bits: its row says so, and shaders/shared/volume_lookup.glsl what.
bool volumeAnswers(const BiasMethod& method);

class VolumeVisibility {
 public:
  explicit VolumeVisibility(const gpu::Device& device) : programs_(device) {}

  // `pass` holds the frame's uniforms and takes the result.
  void record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer, const ShadowVolume& volume,
              const VisibilityPass& pass, const BiasMethod& method, bool diagnose);

 private:
  gpu::ComputePrograms programs_;  // compiled at first use
};

}  // namespace gnomon
