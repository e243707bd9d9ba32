#pragma once
// A shadow map on the GPU: one array image for each of its channels (shadow/channel.h). It is drawn slice by slice with
// the parameterization's shaders, once for each pass that writes one of the channels.

#include "shadow/bounded_draws.h"
#include "shadow/channel.h"
#include "shadow/multiview_check.h"
#include "shadow/occluders.h"

#include "shared/shade.glsl"

#include <functional>

namespace gnomon {

// How the second depth layer is found. All give the same bits where the peel's tolerance is 0.
enum class SecondLayer {
  // Both layers in one pass, as colours that a fragment reads, updates and writes in the order of the triangles. For
  // devices with DeviceInfo::orderedAttachmentAccess.
  Ordered,
  // Depth test "greater than the first layer" against its own depth buffer, MIN blending into a float target: no
  // texture is read, and every fragment before the first layer dies in the early depth test.
  Blend,
  // Depth peeling as in the paper: a fragment shader throws away what equals the first layer. Taken in any case where
  // the map has channels that do not blend (Channel::blends).
  Peel,
};

class MapImage final : public Occluders {
 public:
  // A map of these channels and what they need. Throws WorldError where the device cannot hold it. Of two layers, drawn
  // as `second` has it; absent: the fastest way that the device knows.
  MapImage(const gpu::Device& device, const FittedMap& fitted, ChannelSet channels = glsl::kChannelDepth,
           std::optional<SecondLayer> second = {});

  void recordDrawing(gpu::Commands& commands, const MapRenderer& renderer, const SceneBuffers& scene,
                     const LightModel& light, CullMode cull) override;
  void recordVisibility(gpu::Commands& commands, const SceneBuffers& scene, const ReceiverPicture& receivers,
                        VisibilityPass& pass, const ShadowLookup& lookup) const override;
  bool recordDecisions(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer, DecisionPass& pass,
                       std::span<const BiasMethod* const> biases, std::span<const glsl::BiasParams> params,
                       const glsl::ShadeUniforms& shade) const override;
  bool recordFrame(gpu::Commands& commands, const SceneBuffers& scene, FramePass& pass, const ShadowLookup& lookup,
                   const glsl::ShadeUniforms& shade) const override;
  const gpu::Image& depth() const override { return image(glsl::kChannelDepth); }
  const gpu::Image& secondDepth() const { return image(glsl::kChannelSecondDepth); }
  std::vector<float> downloadDepth(const gpu::Device& device) const override;
  std::vector<float> downloadSecondDepth(const gpu::Device& device) const override;
  std::vector<uint32_t> downloadIds(const gpu::Device& device) const override;

  ChannelSet channels() const { return channels_; }
  bool drawsInOrder() const;  // has two layers, drawn as SecondLayer::Ordered
  // What fragments read that are drawn so, at this binding; any image where nothing is read there.
  const gpu::Image& inOrder(uint32_t binding) const;
  // Of one channel, which the map must have; sliceCount slices.
  const gpu::Image& image(ChannelSet channel) const;
  // The same, or where the map lacks it another: for shaders that declare more than they read.
  const gpu::Image& imageOrAny(ChannelSet channel) const;
  int sliceCount() const { return fitted().map.sliceCount; }

 private:
  friend class MapRenderer;
  ChannelSet channels_;
  SecondLayer second_;
  std::vector<std::pair<ChannelSet, gpu::Image>> images_;
  gpu::Image depthsInOrder_, idsInOrder_;  // pairs of which images_ holds the components, where they are drawn in order
  gpu::Image peelDepth_;                   // made at the first peel
  gpu::OrderedTargets orderedTargets_;
};

// One slice for a renderer to draw by itself.
struct SliceToDraw {
  int slice = 0;
  int side = 0;                                 // texels; viewport and scissor are set to them
  glm::mat4 clipFromWorld{1.0f};                // Vulkan's clip space
  bool mirrors = false;                         // what winds counter-clockwise seen from the light is clockwise on it
  VkFormat depthFormat = VK_FORMAT_D32_SFLOAT;  // test LESS; clamp depth, so that casters before the near end count
  // Of colour 1, where the map has ids: location 1 stores a triangle's (triangleId in scene/scene_buffers.h). Colour 0
  // is undefined then.
  VkFormat idFormat = VK_FORMAT_UNDEFINED;
};
using DrawSlice = std::function<void(VkCommandBuffer commands, const SliceToDraw& slice)>;

class MapRenderer {
 public:
  explicit MapRenderer(const gpu::Device& device);

  // `light` decides which solids may be culled: one that holds the light within its bounds shows it back
  // faces only, and is drawn whole. Throws WorldError where the map asks for SlicePasses::Multiview and the
  // device draws other slices so. The first map that does not ask for a pass a slice is kept waiting by the
  // check of the device.
  void record(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map, const LightModel& light,
              CullMode cull) const;

  // The same, drawn by somebody else: `draw` is called once a slice, between the begin and the end of a rendering. Of
  // maps of matrices with one layer, with or without ids.
  void recordDrawnBy(gpu::Commands& commands, MapImage& map, const DrawSlice& draw) const;

  // Compiles and makes all that record() will need of such a scene and map.
  void prepare(const SceneBuffers& scene, MapImage& map) const;

  // Of what else is made of maps (ShadowVolume), compiled at first use.
  const gpu::ComputePrograms& programs() const { return computePrograms_; }

 private:
  struct Key {
    SliceShaders shaders;
    int pass;  // glsl::kPass*
    bool masked;
    int mapKind;
    uint32_t viewMask;
    ChannelSet stored;  // what the pass writes
    std::vector<VkFormat> colorFormats;
    std::vector<gpu::VertexStream> vertexStreams;  // of a VertexSource; none: the scene's tables
    // Or else the rasterizer's own depth is all that is stored.
    bool needsFragments() const { return masked || !shaders.rasterizedDepth || !colorFormats.empty(); }
    bool ordered() const { return pass == glsl::kPassOrdered; }
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
  Key keyOf(const Slice& slice, bool masked, const VertexSource* source) const;
  std::vector<ChannelPass> passesOf(const MapImage& map) const;
  Slice sliceOf(MapImage& map, int first, int count, ChannelPass pass) const;
  // How a draw's triangles are culled: sheets not at all, solids by the side they show the light.
  enum class Group { Sheets, Solids, MirroredSolids };
  using Grouping = std::function<Group(const Draw&)>;
  void recordSlices(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map, const LightModel& light,
                    CullMode cull, bool multiview) const;
  gpu::RenderTargets targetsOf(MapImage& map, ChannelPass pass) const;
  bool takesMultiview(const MapImage& map) const;
  void recordCorners(gpu::Commands& commands, const SceneBuffers& scene, const Slice& slice,
                     const Grouping& groupOf) const;
  void recordBounds(gpu::Commands& commands, const SceneBuffers& scene, const Slice& slice,
                    const Grouping& groupOf) const;

  const gpu::Device& device_;
  gpu::ComputePrograms computePrograms_;
  mutable std::vector<std::unique_ptr<Entry>> programs_;  // compiled at first use
  mutable BoundedDraws bounded_;
  mutable std::vector<std::pair<SliceShaders, MultiviewCheck>> multiviewChecks_;
};

}  // namespace gnomon
