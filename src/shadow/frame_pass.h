#pragma once
// The frame pass: what the camera sees, its visibility by one map, bias and filter, and its shaded colour, in one draw
// of the scene after its depth. For a picture of one method. Where several methods or diagnoses are wanted, the
// G-buffer is drawn once and VisibilityPass and RadiancePass look it up; both give each pixel the same receiver, but
// for its last bits, and so the same verdict (shared/plane_view.glsl).
//
// A triangle's plane is found once for all its pixels, and what a draw has in common comes as push constants: on
// lavapipe half of those two passes' time goes into reading the same tables once a pixel.

#include "gpu/variants.h"
#include "shadow/bias.h"
#include "shadow/filter.h"
#include "shadow/map_image.h"

#include <memory>
#include <vector>

namespace gnomon {

class FramePass {
 public:
  FramePass(const gpu::Device& device, int width, int height);

  // Uploads `shade` (shadeUniforms in visibility_pass.h), so one recording at a time. Compiles its pipelines on first
  // use; throws WorldError that names a user's file and line where that does not compile.
  void record(gpu::Commands& commands, const SceneBuffers& scene, const MapImage& map, const BiasMethod& method,
              const ChosenFilter& filter, const glsl::ShadeUniforms& shade);

  // Of the last recording. RGBA32F: linear rgb; black where there is no surface.
  const gpu::Image& radiance() const { return radiance_; }

 private:
  // Specialization constants of shade_frame.frag.glsl.
  struct Key {
    int32_t method, mapKind, sliceCount, instanced, channels, filter, tapCount, textured, masked;
    UserBiasKey user;
    bool operator==(const Key&) const = default;
  };
  gpu::GraphicsProgram makeProgram(const Key& key) const;
  void createTargets();
  void recordDepth(gpu::Commands& commands, const SceneBuffers& scene, const glsl::CameraView& camera) const;

  const gpu::Device& device_;
  const int width_, height_;
  gpu::Image radiance_, depth_;  // made at the first use
  gpu::Buffer shadeUniforms_, frameUniforms_;
  gpu::GraphicsProgram opaqueDepth_, maskedDepth_;
  gpu::Variants<Key, gpu::GraphicsProgram> variants_;
};

}  // namespace gnomon
