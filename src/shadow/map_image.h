#pragma once
// A planar shadow map on the GPU: an array of D32 layers, drawn once a layer with depth only.

#include "shadow/parameterization.h"

#include "shared/shade.glsl"

namespace gnomon {

enum class CullMode {
  Solids,  // back faces of closed one-sided meshes, seen from the light, are left out (Weiskopf & Ertl 2003,
           // section 4)
  None,
};

// "solids" or "none". Throws UsageError.
CullMode parseCullMode(const std::string& name);
const char* cullModeName(CullMode mode);

class MapImage {
 public:
  // Throws WorldError where the device cannot hold the map.
  MapImage(const gpu::Device& device, const FittedMap& fitted);

  const gpu::Image& depth() const { return depth_; }         // D32, layerCount layers
  const gpu::Buffer& uniforms() const { return uniforms_; }  // glsl::MapUniforms
  int layerCount() const { return layerCount_; }
  int kind() const { return kind_; }  // glsl::kMap*

 private:
  gpu::Image depth_;
  gpu::Buffer uniforms_;
  int layerCount_ = 0;
  int kind_ = 0;
};

class MapRenderer {
 public:
  explicit MapRenderer(const gpu::Device& device);

  // `light` decides which solids may be culled: one that holds the light within its bounds shows it back
  // faces only, and is drawn whole.
  void record(gpu::Commands& commands, const SceneBuffers& scene, const MapImage& map,
              const LightModel& light, CullMode cull) const;

 private:
  gpu::GraphicsProgram opaque_;
  gpu::GraphicsProgram masked_;
};

}  // namespace gnomon
