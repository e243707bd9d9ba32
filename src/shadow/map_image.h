#pragma once
// A shadow map on the GPU: an array of D32 layers, drawn once a layer by the shaders that the
// parameterization gives, and for two-layer biases a second array with the nearest depth behind the first.

#include "shadow/bias.h"
#include "shadow/bounded_draws.h"
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

// How the second layer is found. Both give the same bits where the peel's tolerance is 0.
enum class SecondLayer {
  // Depth test "greater than the first layer" against its own depth buffer, MIN blending into a float target:
  // no texture is
  // read, and every fragment before the first layer dies in the early depth test.
  Blend,
  // Depth peeling as in the paper: a fragment shader throws away what equals the first layer.
  Peel,
};

class MapImage {
 public:
  // Throws WorldError where the device cannot hold the map.
  MapImage(const gpu::Device& device, const FittedMap& fitted, MapContent content = MapContent::OneLayer);

  const gpu::Image& depth() const { return depth_; }         // D32, layerCount layers
  const gpu::Image& secondDepth() const { return second_; }  // R32F; only of TwoLayers
  const gpu::Buffer& uniforms() const { return uniforms_; }  // glsl::MapUniforms
  MapContent content() const { return content_; }
  int layerCount() const { return fitted_.map.layerCount; }
  int kind() const { return fitted_.map.kind; }  // glsl::kMap*

 private:
  friend class MapRenderer;
  FittedMap fitted_;
  gpu::Image depth_;
  gpu::Image second_;
  gpu::Image peelDepth_;  // made at the first peel
  gpu::Buffer uniforms_;
  MapContent content_ = MapContent::OneLayer;
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
  enum class Pass { First, Blend, Peel };  // kPass
  struct Key {
    LayerShaders shaders;
    Pass pass;
    bool masked;
    int mapKind;
    uint32_t viewMask;
    bool operator==(const Key&) const = default;
  };
  struct Entry {
    Key key;
    gpu::GraphicsProgram program;
  };
  const gpu::GraphicsProgram& program(const Key& key) const;
  // What one pass draws.
  struct Layer {
    const MapImage& map;
    int index;
    int count;  // 1, or all at once
    Pass pass;
    gpu::RenderTargets targets;
  };
  // How a draw's triangles are culled: sheets not at all, solids by the side they show the light.
  enum class Group { Sheets, Solids, MirroredSolids };
  using Grouping = std::function<Group(const Draw&)>;
  void recordLayers(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map, const LightModel& light,
                    CullMode cull, SecondLayer method, bool multiview) const;
  bool takesMultiview(const MapImage& map) const;
  void recordCorners(gpu::Commands& commands, const SceneBuffers& scene, const Layer& layer,
                     const Grouping& groupOf) const;
  void recordBounds(gpu::Commands& commands, const SceneBuffers& scene, const Layer& layer,
                    const Grouping& groupOf) const;

  const gpu::Device& device_;
  mutable std::vector<std::unique_ptr<Entry>> programs_;  // compiled at first use
  mutable BoundedDraws bounded_;
  mutable std::vector<std::pair<LayerShaders, MultiviewCheck>> multiviewChecks_;
};

}  // namespace gnomon
