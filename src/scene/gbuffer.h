#pragma once
// The G-buffer is a visibility buffer: each pixel names the triangle it sees, and everything else (point, plane,
// material) is fetched from the triangle itself, the same way in the shaders and, in double, in the truth.

#include "scene/scene_buffers.h"

#include <vector>

namespace gnomon {

glsl::CameraView cameraView(const Camera& camera, int width, int height);

class GBuffer {
 public:
  GBuffer(const gpu::Device& device, int width, int height);

  // Draws the scene as the camera sees it: single-sided materials from the front only, holes left open.
  void record(gpu::Commands& commands, const SceneBuffers& scene, const glsl::CameraView& camera) const;

  // R32G32_UINT, one glsl::PrimitiveId a pixel, triangles counted through the whole scene.
  const gpu::Image& primitiveIds() const { return ids_; }

 private:
  gpu::GraphicsProgram opaque_;
  gpu::GraphicsProgram masked_;
  gpu::Image ids_;
  gpu::Image depth_;
};

// The picture's primitives with triangles counted within their mesh, as the truth names them.
std::vector<glsl::PrimitiveId> downloadPrimitiveIds(const gpu::Device& device, const GBuffer& gbuffer,
                                                    const SceneBuffers& scene);

}  // namespace gnomon
