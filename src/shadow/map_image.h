#pragma once
// A shadow map on the GPU: an array of D32 layers, drawn once a layer by the shaders that the
// parameterization gives, and for two-layer biases a second array with the nearest depth behind the first.

#include "shadow/bias.h"
#include "shadow/bounded_draws.h"
#include "shadow/multiview_check.h"
#include "shadow/occluders.h"

#include "shared/shade.glsl"

#include <functional>

namespace gnomon {

// How the second layer is found. Both give the same bits where the peel's tolerance is 0.
enum class SecondLayer {
  // Depth test "greater than the first layer" against its own depth buffer, MIN blending into a float target:
  // no texture is
  // read, and every fragment before the first layer dies in the early depth test.
  Blend,
  // Depth peeling as in the paper: a fragment shader throws away what equals the first layer.
  Peel,
};

class MapImage final : public Occluders {
 public:
  // Throws WorldError where the device cannot hold the map.
  MapImage(const gpu::Device& device, const FittedMap& fitted, MapContent content = MapContent::OneLayer);

  void recordDrawing(gpu::Commands& commands, const MapRenderer& renderer, const SceneBuffers& scene,
                     const LightModel& light, CullMode cull) override;
  void recordVisibility(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                        VisibilityPass& pass, const ShadowLookup& lookup) const override;
  const gpu::Image& depth() const override { return depth_; }  // layerCount layers
  const gpu::Image& secondDepth() const { return second_; }    // R32F; only of TwoLayers
  std::vector<float> downloadDepth(const gpu::Device& device) const override;
  std::vector<float> downloadSecondDepth(const gpu::Device& device) const override;

  MapContent content() const { return content_; }
  int layerCount() const { return fitted().map.layerCount; }

 private:
  friend class MapRenderer;
  gpu::Image depth_;
  gpu::Image second_;
  gpu::Image peelDepth_;  // made at the first peel
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

  // Of what else is made of maps (ShadowVolume), compiled at first use.
  const gpu::ComputePrograms& programs() const { return computePrograms_; }

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
  gpu::ComputePrograms computePrograms_;
  mutable std::vector<std::unique_ptr<Entry>> programs_;  // compiled at first use
  mutable BoundedDraws bounded_;
  mutable std::vector<std::pair<LayerShaders, MultiviewCheck>> multiviewChecks_;
};

}  // namespace gnomon
