#include "shadow/frame_pass.h"

#include "base/check.h"
#include "base/error.h"
#include "shadow/user_bias.h"

#include <array>

namespace gnomon {

namespace {

constexpr VkFormat kRadianceFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

// As shadow/frame_draw.glsl declares it.
struct FramePush {
  glm::mat4 worldFromMesh;
  glm::vec4 baseColor;
  int32_t textureIndex;
  float alphaCutoff;
  glsl::FilterParams filterParams;
  uint32_t vertexSum;
};

gpu::GraphicsDesc depthDesc(const char* name, const char* fragment) {
  return {.name = name,
          .vertex = {"scene/project_to_camera.vert.glsl", {}},
          .fragment = {fragment, {}},
          .depthFormat = VK_FORMAT_D32_SFLOAT,
          .depthCompare = VK_COMPARE_OP_GREATER};
}

gpu::ImageDesc targetDesc(const char* name, VkFormat format, int width, int height, VkImageUsageFlags usage) {
  return {.name = name,
          .format = format,
          .width = static_cast<uint32_t>(width),
          .height = static_cast<uint32_t>(height),
          .usage = usage};
}

template <typename T>
gpu::Buffer uniformBuffer(const gpu::Device& device, const char* name) {
  return {device, {.name = name, .size = sizeof(T), .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}};
}

glsl::FrameUniforms frameUniforms(const glsl::ShadeUniforms& shade, const glsl::LightFrame& frame) {
  return {.eye = glsl::eyeView(shade.camera, frame),
          .axisL = glsl::directionFromWorld(frame, shade.camera.forwardW),
          .coneAxisL = glsl::directionFromWorld(frame, shade.coneAxisW),
          .towardsL = glsl::directionFromWorld(frame, shade.lightW)};
}

// How the G-buffer culls, in the order in which it draws (GBuffer::record).
struct Group {
  bool masked, doubleSided, mirrored;
  bool holds(const Draw& draw) const {
    return draw.masked == masked && draw.doubleSided == doubleSided && (doubleSided || draw.mirrored == mirrored);
  }
  void setCulling(gpu::Commands& commands) const {
    commands.setCulling(doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT,
                        mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
  }
};
constexpr std::array<Group, 6> kGroups = {{{false, true, false},
                                           {false, false, false},
                                           {false, false, true},
                                           {true, true, false},
                                           {true, false, false},
                                           {true, false, true}}};

}  // namespace

FramePass::FramePass(const gpu::Device& device, int width, int height)
    : device_(device), width_(width), height_(height) {}

void FramePass::createTargets() {
  if (radiance_.handle() != VK_NULL_HANDLE) return;
  shadeUniforms_ = uniformBuffer<glsl::ShadeUniforms>(device_, "frame's shade uniforms");
  frameUniforms_ = uniformBuffer<glsl::FrameUniforms>(device_, "frame uniforms");
  opaqueDepth_ = gpu::GraphicsProgram(device_, depthDesc("draw camera depth", ""));
  maskedDepth_ =
      gpu::GraphicsProgram(device_, depthDesc("draw camera depth, masked", "scene/leave_holes_open.frag.glsl"));
  radiance_ =
      gpu::Image(device_, targetDesc("frame", kRadianceFormat, width_, height_, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT));
  depth_ = gpu::Image(device_, targetDesc("frame depth", VK_FORMAT_D32_SFLOAT, width_, height_,
                                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT));
}

gpu::GraphicsProgram FramePass::makeProgram(const Key& key) const {
  const gpu::GraphicsDesc desc{.name = "draw frame",
                               .vertex = {"shadow/pull_frame_triangle.vert.glsl", {}},
                               .fragment = shaderWith("shadow/shade_frame.frag.glsl", key.user.bias),
                               .specializations = {{.id = 0, .value = key.method},
                                                   {.id = 2, .value = key.mapKind},
                                                   {.id = 3, .value = key.sliceCount},
                                                   {.id = 4, .value = key.instanced},
                                                   {.id = 5, .value = key.channels},
                                                   {.id = 6, .value = key.filter},
                                                   {.id = 7, .value = key.tapCount},
                                                   {.id = 8, .value = key.textured},
                                                   {.id = 9, .value = key.masked}},
                               .colorFormats = {kRadianceFormat},
                               .depthFormat = VK_FORMAT_D32_SFLOAT,
                               .depthCompare = VK_COMPARE_OP_EQUAL,
                               .depthWrite = false};
  try {
    return gpu::GraphicsProgram(device_, desc);
  } catch (const WorldError& error) {
    if (key.user.bias == nullptr) throw;
    throw WorldError(inUsersWords(error.what(), *key.user.bias));
  }
}

void FramePass::recordDepth(gpu::Commands& commands, const SceneBuffers& scene, const glsl::CameraView& camera) const {
  commands.beginRendering({.colors = {}, .depth = &depth_, .clearDepth = 0.0f, .layer = {}});
  for (const bool masked : {false, true}) {
    std::vector<gpu::Binding> bindings = {
        {glsl::kBindPositions, scene.positions}, {glsl::kBindInstances, scene.instances}, {glsl::kBindUvs, scene.uvs}};
    if (masked) {
      bindings.emplace_back(glsl::kBindMaterials, scene.materials);
      bindings.emplace_back(glsl::kBindTextures, scene.textures);
      bindings.emplace_back(glsl::kBindTexels, scene.texels);
    }
    commands.bind(masked ? maskedDepth_ : opaqueDepth_, gpu::asPush(camera.clipFromWorld), bindings);
    commands.bindIndexBuffer(scene.triangles);
    for (const Group& group : kGroups) {
      if (group.masked != masked) continue;
      group.setCulling(commands);
      recordDraws(commands, scene, [&](const Draw& draw) { return group.holds(draw); });
    }
  }
  commands.endRendering();
}

// Of fragments at the same depth the G-buffer keeps the first, and this pass, which lets through what is equal, the
// last: so all is drawn in the reverse order.
void FramePass::record(gpu::Commands& commands, const SceneBuffers& scene, const MapImage& map,
                       const BiasMethod& method, const ChosenFilter& filter, const glsl::ShadeUniforms& shade) {
  GNOMON_CHECK_EQ(method.channels & ~map.channels(), 0);
  createTargets();
  gpu::upload(device_, shadeUniforms_, gpu::asPush(shade));
  gpu::upload(device_, frameUniforms_, gpu::asPush(frameUniforms(shade, map.fitted().frame)));
  std::vector<gpu::Binding> bindings = {{glsl::kBindPositions, scene.positions},
                                        {glsl::kBindTriangles, scene.triangles},
                                        {glsl::kBindUvs, scene.uvs},
                                        {glsl::kBindNormals, scene.normals},
                                        {glsl::kBindTextures, scene.textures},
                                        {glsl::kBindTexels, scene.texels},
                                        {glsl::kBindMap, map.uniforms()},
                                        {glsl::kBindShade, shadeUniforms_},
                                        {glsl::kBindFrame, frameUniforms_}};
  for (const Channel& channel : channels()) bindings.emplace_back(channel.binding, map.imageOrAny(channel.bit));
  recordDepth(commands, scene, shade.camera);
  commands.barrier("the camera's depths are written -> fragments are tested against them");
  commands.beginRendering({.colors = {{.image = &radiance_, .clear = VkClearColorValue{}}}, .depth = &depth_});
  for (auto group = kGroups.rbegin(); group != kGroups.rend(); ++group) {
    const gpu::GraphicsProgram* bound = nullptr;
    for (auto next = scene.draws.rbegin(); next != scene.draws.rend(); ++next) {
      const Draw& draw = *next;
      if (!group->holds(draw)) continue;
      const FramePush push{draw.worldFromMesh,    draw.material.baseColor,
                           draw.material.texture, draw.material.alphaCutoff,
                           filter.params,         2 * draw.firstIndex + draw.indexCount - 1};
      const gpu::GraphicsProgram& wanted =
          variants_.get({method.id, map.kind(), map.sliceCount(), scene.instanced ? 1 : 0, method.channels, filter.id,
                         filter.tapCount, draw.material.texture >= 0 ? 1 : 0, group->masked ? 1 : 0, method.user},
                        [&](const Key& key) { return makeProgram(key); });
      if (bound != &wanted) {
        commands.bind(wanted, gpu::asPush(push), bindings);
        group->setCulling(commands);
        bound = &wanted;
      } else {
        commands.push(wanted, gpu::asPush(push));
      }
      commands.draw(draw.indexCount, 1, draw.firstIndex, 0);
    }
  }
  commands.endRendering();
}

}  // namespace gnomon
