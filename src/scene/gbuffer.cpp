#include "scene/gbuffer.h"

#include <cmath>

namespace gnomon {

namespace {

gpu::GraphicsDesc programDesc(const char* name, bool masked) {
  return {.name = name,
          .vertex = {"scene/project_to_camera.vert.glsl", {}},
          .fragment = {"scene/draw_primitive_ids.frag.glsl", {}},
          .specializations = {{.id = 0, .value = masked ? 1 : 0}},
          .colorFormats = {VK_FORMAT_R32G32_UINT},
          .depthFormat = VK_FORMAT_D32_SFLOAT,
          .depthCompare = VK_COMPARE_OP_GREATER};
}

}  // namespace

glsl::CameraView cameraView(const Camera& camera, int width, int height) {
  const glm::mat4& worldFromEye = camera.worldFromEye;
  glsl::CameraView view{};
  view.eyeW = glm::vec3(worldFromEye[3]);
  view.rightW = glm::normalize(glm::vec3(worldFromEye[0]));
  view.upW = glm::normalize(glm::vec3(worldFromEye[1]));
  view.forwardW = -glm::normalize(glm::vec3(worldFromEye[2]));
  view.tanHalfY = std::tan(0.5f * camera.yFovRad);
  view.tanHalfX = view.tanHalfY * static_cast<float>(width) / static_cast<float>(height);
  view.width = width;
  view.height = height;

  // Reversed depth without a far plane: z_clip = near, w = distance; 1 at the near plane, 0 at infinity.
  glm::mat4 clipFromEye(0.0f);
  clipFromEye[0][0] = 1.0f / view.tanHalfX;
  clipFromEye[1][1] = -1.0f / view.tanHalfY;
  clipFromEye[2][3] = -1.0f;
  clipFromEye[3][2] = camera.zNear;
  const glm::mat3 eyeFromWorld = glm::transpose(glm::mat3(view.rightW, view.upW, -view.forwardW));
  glm::mat4 eyeFromWorldH(eyeFromWorld);
  eyeFromWorldH[3] = glm::vec4(-(eyeFromWorld * view.eyeW), 1.0f);
  view.clipFromWorld = clipFromEye * eyeFromWorldH;
  return view;
}

GBuffer::GBuffer(const gpu::Device& device, int width, int height)
    : opaque_(device, programDesc("draw primitive ids", false)),
      masked_(device, programDesc("draw primitive ids, masked", true)),
      ids_(device, {.name = "primitive ids",
                    .format = VK_FORMAT_R32G32_UINT,
                    .width = static_cast<uint32_t>(width),
                    .height = static_cast<uint32_t>(height),
                    .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}),
      depth_(device, {.name = "camera depth",
                      .format = VK_FORMAT_D32_SFLOAT,
                      .width = static_cast<uint32_t>(width),
                      .height = static_cast<uint32_t>(height),
                      .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT}) {}

void GBuffer::record(gpu::Commands& commands, const SceneBuffers& scene, const glsl::CameraView& camera) const {
  commands.beginRendering({.colors = {{.image = &ids_, .clear = VkClearColorValue{.uint32 = {0, 0, 0, 0}}}},
                           .depth = &depth_,
                           .clearDepth = 0.0f});
  for (const bool masked : {false, true}) {
    commands.bind(masked ? masked_ : opaque_, gpu::asPush(camera.clipFromWorld),
                  {{glsl::kBindPositions, scene.positions},
                   {glsl::kBindInstances, scene.instances},
                   {glsl::kBindUvs, scene.uvs},
                   {glsl::kBindMaterials, scene.materials},
                   {glsl::kBindTextures, scene.textures},
                   {glsl::kBindTexels, scene.texels}});
    commands.bindIndexBuffer(scene.triangles);
    commands.setCulling(VK_CULL_MODE_NONE, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    recordDraws(commands, scene, [&](const Draw& draw) { return draw.masked == masked && draw.doubleSided; });
    commands.setCulling(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    recordDraws(commands, scene,
                [&](const Draw& draw) { return draw.masked == masked && !draw.doubleSided && !draw.mirrored; });
    commands.setCulling(VK_CULL_MODE_BACK_BIT, VK_FRONT_FACE_CLOCKWISE);
    recordDraws(commands, scene,
                [&](const Draw& draw) { return draw.masked == masked && !draw.doubleSided && draw.mirrored; });
  }
  commands.endRendering();
}

std::vector<glsl::PrimitiveId> downloadPrimitiveIds(const gpu::Device& device, const GBuffer& gbuffer,
                                                    const SceneBuffers& scene) {
  auto ids = gpu::downloadAs<glsl::PrimitiveId>(device, gbuffer.primitiveIds());
  for (glsl::PrimitiveId& id : ids)
    if (id.instancePlusOne != 0) id.triangle -= scene.firstTriangles[id.instancePlusOne - 1];
  return ids;
}

}  // namespace gnomon
