#pragma once
// A shadow map on the GPU: for each of its channels (shadow/channel.h) an array of slices, drawn slice by slice by the
// shaders that the parameterization gives, once for each pass that writes one of them.

#include "shadow/bounded_draws.h"
#include "shadow/channel.h"
#include "shadow/multiview_check.h"
#include "shadow/parameterization.h"

#include "shared/shade.glsl"

#include <functional>

namespace gnomon {

enum class CullMode {
  Solids,  // back faces of closed one-sided meshes, seen from the light, are left out (Weiskopf & Ertl 2003,
           // section 4)
  None,
};

// "solids" or "none". Throws UsageError.
CullMode parseCullMode(const std::string& name);
const char* cullModeName(CullMode mode);

// How the second depth layer is found. Both give the same bits where the peel's tolerance is 0.
enum class SecondLayer {
  // Depth test "greater than the first layer" against its own depth buffer, MIN blending into a float target: no texture
  // is read, and every fragment before the first layer dies in the early depth test.
  Blend,
  // Depth peeling as in the paper: a fragment shader throws away what equals the first layer.
  Peel,
};

class MapImage {
 public:
  // A map of these channels and what they need. Throws WorldError where the device cannot hold it.
  MapImage(const gpu::Device& device, const FittedMap& fitted, ChannelSet channels = glsl::kChannelDepth);

  ChannelSet channels() const { return channels_; }
  // Of one channel, which the map must have; layerCount slices.
  const gpu::Image& image(ChannelSet channel) const;
  const gpu::Image& depth() const { return image(glsl::kChannelDepth); }
  const gpu::Image& secondDepth() const { return image(glsl::kChannelSecondDepth); }
  // The same, or where the map lacks it another: for shaders that declare more than they read.
  const gpu::Image& imageOrAny(ChannelSet channel) const;
  const gpu::Buffer& uniforms() const { return uniforms_; }  // glsl::MapUniforms
  int layerCount() const { return fitted_.map.layerCount; }
  int kind() const { return fitted_.map.kind; }  // glsl::kMap*

 private:
  friend class MapRenderer;
  FittedMap fitted_;
  ChannelSet channels_;
  std::vector<std::pair<ChannelSet, gpu::Image>> images_;
  gpu::Image peelDepth_;  // made at the first peel
  gpu::Buffer uniforms_;
};

class MapRenderer {
 public:
  explicit MapRenderer(const gpu::Device& device);

  // `light` decides which solids may be culled: one that holds the light within its bounds shows it back
  // faces only, and is drawn whole. Throws WorldError where the map asks for LayerPasses::Multiview and the
  // device draws other layers so. The first map that does not ask for a pass a layer is kept waiting by the
  // check of the device.
  void record(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map, const LightModel& light, CullMode cull,
              SecondLayer method = SecondLayer::Blend) const;

 private:
  struct Key {
    LayerShaders shaders;
    int pass;  // glsl::kPass*
    bool masked;
    int mapKind;
    uint32_t viewMask;
    ChannelSet stored;  // what the pass writes
    std::vector<VkFormat> colorFormats;
    // Or else the rasterizer's own depth is all that is stored.
    bool needsFragments() const { return masked || !shaders.rasterizedDepth || !colorFormats.empty(); }
    bool operator==(const Key&) const = default;
  };
  struct Entry {
    Key key;
    gpu::GraphicsProgram program;
  };
  const gpu::GraphicsProgram& program(const Key& key) const;
  // What one pass draws.
  struct Slice {
    const MapImage& map;
    int index;
    int count;  // 1, or all at once
    ChannelPass pass;
    int shaderPass;  // glsl::kPass*
    gpu::RenderTargets targets;
  };
  Key keyOf(const Slice& slice, bool masked) const;
  // How a draw's triangles are culled: sheets not at all, solids by the side they show the light.
  enum class Group { Sheets, Solids, MirroredSolids };
  using Grouping = std::function<Group(const Draw&)>;
  void recordSlices(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map, const LightModel& light,
                    CullMode cull, SecondLayer method, bool multiview) const;
  gpu::RenderTargets targetsOf(MapImage& map, ChannelPass pass, SecondLayer method) const;
  bool takesMultiview(const MapImage& map) const;
  void recordCorners(gpu::Commands& commands, const SceneBuffers& scene, const Slice& slice,
                     const Grouping& groupOf) const;
  void recordBounds(gpu::Commands& commands, const SceneBuffers& scene, const Slice& slice,
                    const Grouping& groupOf) const;

  const gpu::Device& device_;
  mutable std::vector<std::unique_ptr<Entry>> programs_;  // compiled at first use
  mutable BoundedDraws bounded_;
  mutable std::vector<std::pair<LayerShaders, MultiviewCheck>> multiviewChecks_;
};

}  // namespace gnomon
