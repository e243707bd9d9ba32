#pragma once
// The first occluder along each of a light's rays, rendered on a device: the depths of a shadow map (map_image.h) or
// the bits of a shadow volume (vsv/shadow_volume.h). Code that lights a picture uses this interface and need not know
// which.

#include "gpu/commands.h"
#include "scene/receiver_picture.h"
#include "shadow/filter.h"
#include "shadow/parameterization.h"

#include "shared/shade.glsl"

#include <span>
#include <string>
#include <vector>

namespace gnomon {

class DecisionPass;
class FramePass;
class MapRenderer;
class VisibilityPass;

enum class CullMode {
  // Back faces of closed one-sided meshes, seen from the light, are left out (Weiskopf & Ertl 2003, section 4).
  Solids,
  None,
};

// "solids" or "none". Throws UsageError.
CullMode parseCullMode(const std::string& name);
const char* cullModeName(CullMode mode);

// How a picture's pixels are looked up. The bias's parameters are in the pass's uniforms.
struct ShadowLookup {
  const BiasMethod& bias;
  ChosenFilter filter = glsl::kShadowFilterNone;
  bool diagnose = false;  // also which texel decided each pixel, and how; without a filter only
  // Of one picture: in one dispatch, whose pipeline compiles sooner than several that would take less time together.
  bool once = false;
  bool oneGroup = false;  // a corner of the picture only: so that pipelines are compiled
  // Where visibility goes, instead of the pass's buffer: a storage image in GENERAL, R32_SFLOAT, R16_SFLOAT or
  // R8_UNORM.
  const gpu::Image* into = nullptr;
};

class Occluders {
 public:
  virtual ~Occluders() = default;

  const FittedMap& fitted() const { return fitted_; }
  int kind() const { return fitted_.map.kind; }              // glsl::kMap*
  const gpu::Buffer& uniforms() const { return uniforms_; }  // glsl::MapUniforms

  // Whether recordFit() takes it: kind, slices, size and shaders are these.
  bool hasFormOf(const FittedMap& fitted) const;
  // Another fit of the same form, for the commands that follow: the light has moved.
  virtual void recordFit(gpu::Commands& commands, const FittedMap& fitted);

  // Draws them once more. `light` decides which solids may be culled (MapRenderer::record). A barrier must follow.
  virtual void recordDrawing(gpu::Commands& commands, const MapRenderer& renderer, const SceneBuffers& scene,
                             const LightModel& light, CullMode cull) = 0;

  // The visibility of each pixel, into the buffers of `pass`. The parameterization must support bias and filter.
  virtual void recordVisibility(gpu::Commands& commands, const SceneBuffers& scene, const ReceiverPicture& receivers,
                                VisibilityPass& pass, const ShadowLookup& lookup) const = 0;

  // What several biases say of each pixel, in one dispatch of `pass` (DecisionPass::record). False where these
  // occluders have no such pass, and nothing is recorded.
  virtual bool recordDecisions(gpu::Commands&, const SceneBuffers&, const GBuffer&, DecisionPass&,
                               std::span<const BiasMethod* const>, std::span<const glsl::BiasParams>,
                               const glsl::ShadeUniforms&) const {
    return false;
  }

  // The whole picture, visibility and shading, in one pass. False where these
  // occluders have no such pass, and nothing is recorded.
  virtual bool recordFrame(gpu::Commands&, const SceneBuffers&, FramePass&, const ShadowLookup&,
                           const glsl::ShadeUniforms&) const {
    return false;
  }

  // What a medium reads along its view rays: a volume's bits, 128 at a time, or depths, one look-up a sample.
  virtual const gpu::Buffer* bits() const { return nullptr; }  // null where there are depths only
  virtual const gpu::Image& depth() const = 0;  // D32, an array of slices; of a volume: what its bits were made of

  // The stored depths in host memory, as mapDepth() gives them, rows within slices; 1 where nothing is hit.
  virtual std::vector<float> downloadDepth(const gpu::Device& device) const = 0;
  // The nearest behind them; empty where it is not stored.
  virtual std::vector<float> downloadSecondDepth(const gpu::Device&) const { return {}; }
  // Which triangle each depth is of (scene/triangle_ids.h); empty where it is not stored.
  virtual std::vector<uint32_t> downloadIds(const gpu::Device&) const { return {}; }

 protected:
  Occluders(const gpu::Device& device, const FittedMap& fitted, const char* uniformsName);
  Occluders(Occluders&&) = default;
  Occluders& operator=(Occluders&&) = default;

 private:
  FittedMap fitted_;
  gpu::Buffer uniforms_;
};

}  // namespace gnomon
