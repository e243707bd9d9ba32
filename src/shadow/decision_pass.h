#pragma once
// The decision pass: what several biases say of one unfiltered map in one dispatch. They share a pixel's receiver,
// texel and ray, and most of a look-up's time is that. Its bits are those of VisibilityPass, which decides one at a
// time and is what a bias's time is taken of.

#include "gpu/variants.h"
#include "shadow/visibility_pass.h"

namespace gnomon {

// Whether two biases can share a dispatch: they read the same channels, and neither knows surfaces, whose tables and
// walks would be most of it.
bool decidedTogether(const BiasMethod& a, const BiasMethod& b);

// What several methods said of each pixel, as packed as shadow/decide_methods.comp.glsl writes it.
class Decisions {
 public:
  // `planes`: planeCount words a pixel, plane after plane.
  Decisions(std::vector<const BiasMethod*> biases, std::vector<uint32_t> planes);

  // One a pixel: those of VisibilityPass.
  std::vector<glsl::PixelDiagnosis> of(size_t method) const;

  // Of the words: the methods' flags, the texel that they share, and one of each that moves the receiver.
  static size_t planeCount(std::span<const BiasMethod* const> biases);

 private:
  std::vector<const BiasMethod*> biases_;
  std::vector<uint32_t> planes_;
  size_t pixelCount_;
};

class DecisionPass {
 public:
  DecisionPass(const gpu::Device& device, int width, int height);

  // How many of these, from the first on, one dispatch can take.
  size_t mostOf(std::span<const BiasMethod* const> biases) const;

  // Compiles its pipeline on first use; throws as VisibilityPass does. `params`: one a bias; `shade.bias` is not read.
  // Uploads both, so one recording at a time.
  void record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer, const MapImage& map,
              std::span<const BiasMethod* const> biases, std::span<const glsl::BiasParams> params,
              const glsl::ShadeUniforms& shade);
  // Of the last recording, once it has run.
  Decisions download(std::span<const BiasMethod* const> biases) const;

 private:
  struct VariantKey {
    int32_t mapKind, sliceCount, instanced, channels;
    std::vector<int32_t> methods;
    UserBiasKey user;
    bool operator==(const VariantKey&) const = default;
  };
  gpu::ComputeProgram makeProgram(const VariantKey& key) const;

  const gpu::Device& device_;
  size_t pixelCount_;
  glm::uvec3 groupCount_;
  gpu::Buffer uniforms_, params_, planes_;
  gpu::Image noIds_;  // bound where a map has none
  gpu::Variants<VariantKey, gpu::ComputeProgram> variants_;
};

}  // namespace gnomon
