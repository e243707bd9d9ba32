#pragma once
// Where a picture's receivers come from: Gnomon's own G-buffer, a renderer's picture of triangles, or its depth buffer.
// The last two are images of the renderer's, which stay in the layout that is named here while commands read them.

#include "scene/gbuffer.h"

#include "shared/receiver_picture.glsl"

#include <optional>

namespace gnomon {

// How shaders find a pixel's receiver; each is compiled by itself.
enum class ReceiverKind {
  GBuffer,    // R32G32_UINT: the instance plus one, the triangle in the array of all
  Triangles,  // R32G32_UINT: the instance plus one (LentGeometry's), gl_PrimitiveID; 0, 0 where there is nothing
  Depth,      // a depth buffer, and normals if there are any
};

// An image of the renderer's.
struct LentImage {
  VkImageView view = VK_NULL_HANDLE;  // of one layer; of depth its depth aspect
  VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
};

struct DepthReceivers {
  LentImage depth;
  LentImage normals = {};         // of the triangles, in the world
  glsl::ReceiverPicture meaning;  // depthMeaning() fills its first two
};

// Of a projection (Vulkan's clip space, column-major): how depth follows from the distance along the camera's axis.
glsl::ReceiverPicture depthMeaning(const glm::mat4& clipFromEye, float emptyDepth, int normals);

class ReceiverPicture {
 public:
  // These are values: made anew wherever the renderer's images are others.
  ReceiverPicture(const GBuffer& gbuffer) : kind_(ReceiverKind::GBuffer), ids_(&gbuffer.primitiveIds()) {}
  static ReceiverPicture ofTriangles(const LentImage& ids);
  static ReceiverPicture ofDepth(const DepthReceivers& depth);

  ReceiverKind kind() const { return kind_; }
  const glsl::ReceiverPicture& meaning() const { return meaning_; }
  // What shaders read of it; `uniforms` holds meaning(). The bindings point into this.
  void bind(std::vector<gpu::Binding>& bindings, const gpu::Buffer& uniforms) const;
  // The shader with that in its place, and the constant that goes with it.
  static gpu::ShaderSource shader(gpu::ShaderSource source, ReceiverKind kind);
  static gpu::Specialization constant(ReceiverKind kind);

 private:
  ReceiverPicture() = default;
  ReceiverKind kind_ = ReceiverKind::GBuffer;
  const gpu::Image* ids_ = nullptr;
  gpu::Image first_, normals_;  // lent
  glsl::ReceiverPicture meaning_{};
};

// A camera of a renderer's: its matrices, column-major, Vulkan's clip space (y down, z from 0 to w), any depth. A
// jittered or off-centre frustum is taken as it is. Throws WorldError where the projection is not a perspective one.
glsl::CameraView cameraOf(const glm::mat4& worldFromEye, const glm::mat4& clipFromEye, int width, int height);

}  // namespace gnomon
