#pragma once
// The visibility pass (each pixel's visibility by a map, a bias and a filter) and the radiance pass (the shaded
// picture).

#include "gpu/variants.h"
#include "scene/receiver_picture.h"
#include "shadow/bias.h"
#include "shadow/filter.h"
#include "shadow/map_image.h"

#include <span>
#include <vector>

namespace gnomon {

// Numbers of one frame, written to a buffer before it is recorded.
glsl::ShadeUniforms shadeUniforms(const glsl::CameraView& camera, const LightModel& light,
                                  const glsl::BiasParams& bias);

// Of a pass that looks pixels up in a map: of the scene, the receivers (whose `meaning` is in a buffer) and the map.
// `noIds`: bound where a map has none.
std::vector<gpu::Binding> lookupBindings(const SceneBuffers& scene, const ReceiverPicture& receivers,
                                         const gpu::Buffer& meaning, const MapImage& map, const gpu::Image& noIds);
gpu::Image createNoIds(const gpu::Device& device);
// Throws WorldError that names a user's file and line where that does not compile.
gpu::ComputeProgram createLookupProgram(const gpu::Device& device, const gpu::ShaderSource& shader,
                                        const UserBias* user, const std::vector<gpu::Specialization>& constants);

// Work groups of kShadeGroupSide^2 for a picture of so many pixels.
glm::uvec3 shadeGroups(int width, int height);

class VisibilityPass {
 public:
  // Whether it has buffers for what it finds, or writes images alone (ShadowLookup::into) and diagnoses nothing.
  enum class Output { Buffers, Images };
  VisibilityPass(const gpu::Device& device, int width, int height, Output output = Output::Buffers);

  // Compiles its pipeline on first use; throws WorldError that names a user's file and line where that does
  // not compile. A diagnosis is of the unfiltered map: with a filter there is none.
  void record(gpu::Commands& commands, const SceneBuffers& scene, const ReceiverPicture& receivers, const MapImage& map,
              const ShadowLookup& lookup);
  // Compiles what that will need.
  void prepare(const SceneBuffers& scene, ReceiverKind receivers, const MapImage& map, const ShadowLookup& lookup);

  // Before record(), whose pipeline is made for some of them.
  void setUniforms(const glsl::ShadeUniforms& uniforms);
  // The same for the commands that follow, and what a renderer's depth means.
  void recordUniforms(gpu::Commands& commands, const glsl::ShadeUniforms& uniforms,
                      const glsl::ReceiverPicture& meaning);
  const gpu::Buffer& receiverPicture() const { return receiverPicture_; }  // glsl::ReceiverPicture

  // A shader of this pass or a volume's that stores visibility there: as it is, or in an image of that format.
  static gpu::ShaderSource storingIn(gpu::ShaderSource source, const gpu::Image* image);
  // What such a shader is given to store in.
  gpu::Binding storage(const gpu::Image* image) const;

  // Of other looks-up into these buffers (ShadowVolume), compiled at first use.
  const gpu::ComputePrograms& programs() const { return programs_; }

  // Of kShadeGroupSide^2.
  glm::uvec3 groupsOf(const ShadowLookup& lookup) const { return lookup.oneGroup ? glm::uvec3(1) : groupCount_; }
  const gpu::Buffer& uniforms() const { return uniforms_; }
  const gpu::Buffer& visibility() const { return visibility_; }  // float a pixel; 1 lit, kUnknownVisibility
  // glsl::PixelDiagnosis a pixel, made at the first look-up that asks for it: a picture may be so large that a device
  // holds the one and not the other.
  const gpu::Buffer& diagnosisFor(const ShadowLookup& lookup);
  const gpu::Buffer& diagnosis() const { return diagnosis_; }

 private:
  // Specialization constants of shade_visibility.comp.glsl, in the order of their ids.
  struct VariantKey {
    int32_t method, diagnose, mapKind, sliceCount, instanced, channels, filter, tapCount, masked, stage, witnessReach;
    UserBiasKey user;
    ReceiverKind receivers;
    VkFormat stored;  // VK_FORMAT_UNDEFINED: in the buffer
    bool operator==(const VariantKey&) const = default;
  };
  gpu::ComputeProgram makeProgram(const VariantKey& key) const;
  const gpu::ComputeProgram& programOf(const SceneBuffers& scene, ReceiverKind receivers, const MapImage& map,
                                       const ShadowLookup& lookup, int stage);
  static bool inStages(const ShadowLookup& lookup);

  const gpu::Device& device_;
  glm::uvec3 groupCount_;
  gpu::Buffer uniforms_, receiverPicture_, visibility_, diagnosis_;
  int witnessReach_ = 2;                  // of the uniforms
  gpu::Buffer walkers_, walkDispatches_;  // pixels that another dispatch shades (glsl::kStageLists)
  gpu::Image noIds_;                      // bound where a map has none
  gpu::Variants<VariantKey, gpu::ComputeProgram> variants_;
  gpu::ComputePrograms programs_;
};

class RadiancePass {
 public:
  RadiancePass(const gpu::Device& device, int width, int height);

  // Reads the visibility buffer; writes linear rgb, into a buffer that is made at the first use.
  void record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
              const gpu::Buffer& shadeUniforms, const gpu::Buffer& visibility);

  const gpu::Buffer& radiance() const { return radiance_; }  // vec3 a pixel, tightly packed

 private:
  const gpu::Device& device_;
  gpu::ComputePrograms programs_;
  size_t pixelCount_;
  glm::uvec3 groupCount_;
  gpu::Buffer radiance_;
};

}  // namespace gnomon
