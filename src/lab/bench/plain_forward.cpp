#include "lab/bench/plain_forward.h"

#include "shared/plain_forward.glsl"

#include <cstring>

namespace gnomon {

namespace {

constexpr VkFormat kPictureFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  // as FramePass

const std::vector<gpu::VertexStream> kPositionOnly = {{VK_FORMAT_R32G32B32_SFLOAT, 12}};
const std::vector<gpu::VertexStream> kAllStreams = {
    {VK_FORMAT_R32G32B32_SFLOAT, 12}, {VK_FORMAT_R32G32B32_SFLOAT, 12}, {VK_FORMAT_R32G32_SFLOAT, 8}};

glsl::PlainUniforms uniformsOf(const SceneView& view, const LightOnMap& cube, float offset) {
  const FittedMap& fitted = cube.fitted();
  const Exposure exposure = cube.exposure();
  glsl::PlainUniforms plain{.clipFromWorld = view.view().clipFromWorld,
                            .lightW = glm::vec3(cube.light().positionW),
                            .zFar = view.sceneScale(),
                            .lightColor = exposure.lightColor,
                            .offset = offset,
                            .ambient = exposure.ambient};
  glm::mat4 lightFromWorld(1.0f);  // a cube's axes are the world's
  lightFromWorld[3] = glm::vec4(-plain.lightW, 1.0f);
  for (int face = 0; face < 6; ++face)
    plain.faceFromWorld[face] = fitted.map.mapSlices[face].clipFromLight * lightFromWorld;
  return plain;
}

gpu::ImageDesc square(const char* name, VkFormat format, int width, int height, VkImageUsageFlags usage) {
  return {.name = name,
          .format = format,
          .width = static_cast<uint32_t>(width),
          .height = static_cast<uint32_t>(height),
          .usage = usage};
}

gpu::ImageDesc cubeDesc(int side) {
  gpu::ImageDesc desc = square("plain distances", VK_FORMAT_D32_SFLOAT, side, side,
                               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  desc.layerCount = 6;
  desc.array = desc.cube = true;
  return desc;
}

}  // namespace

PlainForward::PlainForward(const SceneView& view, const LightOnMap& cube, float offset)
    : view_(view),
      uniforms_(gpu::createBufferWith(view.device(), "plain uniforms",
                                      std::vector<glsl::PlainUniforms>{uniformsOf(view, cube, offset)},
                                      VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)),
      distances_(view.device(), cubeDesc(cube.fitted().map.width)),
      picture_(view.device(), square("plain picture", kPictureFormat, view.view().width, view.view().height,
                                     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)),
      pictureDepth_(view.device(), square("plain depth", VK_FORMAT_D32_SFLOAT, view.view().width, view.view().height,
                                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)),
      drawFace_(view.device(), {.name = "draw plain face",
                                .vertex = {"bench/project_to_plain_face.vert.glsl", {}},
                                .fragment = {"bench/store_plain_distance.frag.glsl", {}},
                                .depthFormat = VK_FORMAT_D32_SFLOAT,
                                .vertexStreams = kPositionOnly}),
      drawPicture_(view.device(), {.name = "draw plain picture",
                                   .vertex = {"bench/project_to_plain_camera.vert.glsl", {}},
                                   .fragment = {"bench/shade_plainly.frag.glsl", {}},
                                   .colorFormats = {kPictureFormat},
                                   .depthFormat = VK_FORMAT_D32_SFLOAT,
                                   .depthCompare = VK_COMPARE_OP_GREATER,
                                   .vertexStreams = kAllStreams}) {
  uploadTextures();
}

void PlainForward::uploadTextures() {
  const gpu::Device& device = view_.device();
  const Scene& scene = view_.scene();
  std::vector<uint32_t> texels = scene.texels;
  texels.push_back(0xffffffffu);
  std::vector<glsl::TextureInfo> infos = scene.textures;
  infos.push_back({static_cast<uint32_t>(scene.texels.size()), 1, 1, 0, 0, 0});
  const gpu::Buffer staging = gpu::createBufferWith(device, "plain texels", texels);
  gpu::Commands commands(device, "plain textures");
  for (const glsl::TextureInfo& info : infos) {
    textures_.emplace_back(
        device, square("plain texture", VK_FORMAT_R8G8B8A8_SRGB, info.width, info.height, VK_IMAGE_USAGE_SAMPLED_BIT));
    commands.copy(staging, textures_.back(), info.firstTexel * sizeof(uint32_t));
  }
  commands.submitAndWait();
}

// Everything, opaque and of both sides.
void PlainForward::draw(gpu::Commands& commands, const gpu::GraphicsProgram& program, int face) const {
  const SceneBuffers& scene = view_.buffers();
  const bool ofCamera = &program == &drawPicture_;
  int bound = -2;
  for (const Draw& d : scene.draws) {
    const glsl::PlainPush push{d.worldFromMesh, d.material.baseColor, face};
    if (bound == -2 || (ofCamera && bound != d.material.texture)) {
      std::vector<gpu::Binding> bindings = {{glsl::kBindPlain, uniforms_}};
      if (ofCamera) {
        const gpu::Image& texture =
            d.material.texture < 0 ? textures_.back() : textures_[static_cast<size_t>(d.material.texture)];
        bindings.emplace_back(glsl::kBindPlainDistances, distances_);
        bindings.emplace_back(glsl::kBindPlainColor, texture);
      }
      commands.bind(program, gpu::asPush(push), bindings);
      if (ofCamera)
        commands.bindVertexStreams({&scene.positions, &scene.normals, &scene.uvs});
      else
        commands.bindVertexStreams({&scene.positions});
      commands.bindIndexBuffer(scene.triangles);
      bound = d.material.texture;
    } else {
      commands.push(program, gpu::asPush(push));
    }
    commands.drawIndexed(d.indexCount, 1, d.firstIndex, 0, 0);
  }
}

void PlainForward::recordMap(gpu::Commands& commands) const {
  for (uint32_t face = 0; face < 6; ++face) {
    commands.beginRendering({.colors = {}, .depth = &distances_, .clearDepth = 1.0f, .layer = face});
    draw(commands, drawFace_, static_cast<int>(face));
    commands.endRendering();
  }
}

void PlainForward::recordPicture(gpu::Commands& commands) const {
  commands.beginRendering({.colors = {{.image = &picture_, .clear = VkClearColorValue{}}},
                           .depth = &pictureDepth_,
                           .clearDepth = 0.0f,
                           .layer = {}});
  draw(commands, drawPicture_, 0);
  commands.endRendering();
}

}  // namespace gnomon
