#include "scene/receiver_picture.h"

#include "base/check.h"
#include "base/error.h"

#include <cmath>

namespace gnomon {

glsl::ReceiverPicture depthMeaning(const glm::mat4& clipFromEye, float emptyDepth, int normals) {
  // z_clip = m22 z + m32 with z = -t, w = t.
  return {
      .depthScale = -clipFromEye[2][2], .depthOffset = clipFromEye[3][2], .emptyDepth = emptyDepth, .normals = normals};
}

ReceiverPicture ReceiverPicture::ofTriangles(const LentImage& ids) {
  ReceiverPicture picture;
  picture.kind_ = ReceiverKind::Triangles;
  picture.first_ = gpu::Image(ids.view, ids.layout, {.name = "lent picture of triangles"});
  return picture;
}

ReceiverPicture ReceiverPicture::ofDepth(const DepthReceivers& depth) {
  ReceiverPicture picture;
  picture.kind_ = ReceiverKind::Depth;
  picture.meaning_ = depth.meaning;
  picture.first_ = gpu::Image(depth.depth.view, depth.depth.layout, {.name = "lent depth"});
  const bool hasNormals = depth.meaning.normals != glsl::kReceiverNormalsNone;
  GNOMON_CHECK_EQ(hasNormals, depth.normals.view != VK_NULL_HANDLE);
  const LentImage& second = hasNormals ? depth.normals : depth.depth;  // any image, not read
  picture.normals_ = gpu::Image(second.view, second.layout, {.name = "lent normals"});
  return picture;
}

void ReceiverPicture::bind(std::vector<gpu::Binding>& bindings, const gpu::Buffer& uniforms) const {
  if (kind_ != ReceiverKind::Depth) {
    bindings.emplace_back(glsl::kBindPrimitiveIds, ids_ != nullptr ? *ids_ : first_);
    return;
  }
  bindings.emplace_back(glsl::kBindReceiverDepth, first_);
  bindings.emplace_back(glsl::kBindReceiverNormals, normals_);
  bindings.emplace_back(glsl::kBindReceiverPicture, uniforms);
}

gpu::ShaderSource ReceiverPicture::shader(gpu::ShaderSource source, ReceiverKind kind) {
  if (kind == ReceiverKind::Depth)
    source.overrides["scene/surface_fetch.glsl"] = "#include \"scene/surface_from_depth.glsl\"\n";
  return source;
}

gpu::Specialization ReceiverPicture::constant(ReceiverKind kind) {
  return {.id = 12, .value = kind == ReceiverKind::Triangles ? 1 : 0};
}

glsl::CameraView cameraOf(const glm::mat4& worldFromEye, const glm::mat4& clipFromEye, int width, int height) {
  if (clipFromEye[2][3] != -1.0f || clipFromEye[3][3] != 0.0f || clipFromEye[0][0] == 0.0f || clipFromEye[1][1] == 0.0f)
    throw WorldError("the camera's projection is not a perspective one that looks along -z (w = -z); give one that is");
  glsl::CameraView view{};
  view.eyeW = glm::vec3(worldFromEye[3]);
  view.rightW = glm::normalize(glm::vec3(worldFromEye[0]));
  view.upW = glm::normalize(glm::vec3(worldFromEye[1]));
  view.forwardW = -glm::normalize(glm::vec3(worldFromEye[2]));
  view.tanHalfX = 1.0f / clipFromEye[0][0];
  view.tanHalfY = -1.0f / clipFromEye[1][1];
  // x_ndc = m00 x - m20 at distance 1: an off-centre frustum looks aside by as much.
  const glm::vec3 forward = view.forwardW;
  if (clipFromEye[2][0] != 0.0f) view.forwardW += view.rightW * (clipFromEye[2][0] * view.tanHalfX);
  if (clipFromEye[2][1] != 0.0f) view.forwardW -= view.upW * (clipFromEye[2][1] * view.tanHalfY);
  view.width = width;
  view.height = height;
  const glm::mat3 eyeFromWorld = glm::transpose(glm::mat3(view.rightW, view.upW, -forward));
  glm::mat4 eyeFromWorldH(eyeFromWorld);
  eyeFromWorldH[3] = glm::vec4(-(eyeFromWorld * view.eyeW), 1.0f);
  view.clipFromWorld = clipFromEye * eyeFromWorldH;
  return view;
}

}  // namespace gnomon
