#include "shadow/map_image.h"

#include "base/error.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

// As peel_second_depth.frag.glsl declares it.
struct PeelPush {
  int32_t layer;
  float
      tolerance;  // of depth: the rasterizer gives one triangle the same depth every time, so none is needed
};

gpu::GraphicsDesc firstLayerProgram(bool masked) {
  return {.name = masked ? "draw depth, masked" : "draw depth",
          .vertex = {"shadow/project_to_layer.vert.glsl", {}},
          .fragment = {masked ? "shadow/draw_depth_masked.frag.glsl" : "", {}},
          .depthFormat = VK_FORMAT_D32_SFLOAT,
          .depthCompare = VK_COMPARE_OP_LESS};
}

gpu::GraphicsDesc secondLayerProgram(SecondLayer method, bool masked) {
  const bool blend = method == SecondLayer::Blend;
  return {
      .name = blend ? "draw second depth" : "peel second depth",
      .vertex = {"shadow/project_to_layer.vert.glsl", {}},
      .fragment = {blend ? "shadow/draw_second_depth.frag.glsl" : "shadow/peel_second_depth.frag.glsl", {}},
      .specializations = {{.id = 0, .value = masked ? 1 : 0}},
      .colorFormats = {VK_FORMAT_R32_SFLOAT},
      .depthFormat = VK_FORMAT_D32_SFLOAT,
      .depthCompare = blend ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS,
      .depthWrite = !blend,
      .minBlend = blend};
}

gpu::ImageDesc layersDesc(const char* name, VkFormat format, VkImageUsageFlags usage, uint32_t side,
                          uint32_t layerCount) {
  return {.name = name,
          .format = format,
          .width = side,
          .height = side,
          .layerCount = layerCount,
          .array = true,
          .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT};
}

bool holdsLight(const Draw& draw, const LightModel& light) {
  if (light.type == LightType::Directional) return false;
  const glm::vec3 position(light.positionW);
  return glm::all(glm::greaterThanEqual(position, draw.boundsW.lower)) &&
         glm::all(glm::lessThanEqual(position, draw.boundsW.upper));
}

}  // namespace

CullMode parseCullMode(const std::string& name) {
  if (name == "solids") return CullMode::Solids;
  if (name == "none") return CullMode::None;
  throw UsageError(fmt::format("--cull {}: no such mode; choose from solids, none", name));
}

const char* cullModeName(CullMode mode) {
  return mode == CullMode::Solids ? "solids" : "none";
}

MapImage::MapImage(const gpu::Device& device, const FittedMap& fitted, MapContent content)
    : uniforms_(gpu::createBufferWith(
          device, "map uniforms",
          std::vector<glsl::MapUniforms>{{.lightFrame = fitted.frame, .shadowMap = fitted.map}},
          VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)),
      content_(content),
      layerCount_(fitted.map.layerCount),
      kind_(fitted.map.kind) {
  const auto side = static_cast<uint32_t>(fitted.map.side);
  const auto layers = static_cast<uint32_t>(layerCount_);
  depth_ = gpu::Image(device, layersDesc("shadow map depth", VK_FORMAT_D32_SFLOAT,
                                         VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, side, layers));
  if (content == MapContent::TwoLayers)
    second_ = gpu::Image(device, layersDesc("shadow map second depth", VK_FORMAT_R32_SFLOAT,
                                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, side, layers));
}

MapRenderer::MapRenderer(const gpu::Device& device)
    : device_(device),
      first_{{device, firstLayerProgram(false)}, {device, firstLayerProgram(true)}},
      blend_{{device, secondLayerProgram(SecondLayer::Blend, false)},
             {device, secondLayerProgram(SecondLayer::Blend, true)}},
      peel_{{device, secondLayerProgram(SecondLayer::Peel, false)},
            {device, secondLayerProgram(SecondLayer::Peel, true)}} {}

void MapRenderer::recordLayer(gpu::Commands& commands, const SceneBuffers& scene, const MapImage& map,
                              const LightModel& light, CullMode cull, const Pair& programs, int layer,
                              bool readsFirstLayer) const {
  const bool backFaces = map.content() == MapContent::BackFaces;
  const auto culled = [&](const Draw& draw) {
    return (cull == CullMode::Solids || backFaces) && draw.solid && !holdsLight(draw, light);
  };
  const PeelPush push{.layer = layer, .tolerance = 0.0f};
  for (const bool masked : {false, true}) {
    if (masked && (scene.draws.empty() || !scene.draws.back().masked)) continue;
    const gpu::GraphicsProgram& program = masked ? programs.masked : programs.opaque;
    std::vector<gpu::Binding> bindings;
    for (const gpu::ProgramInterface::Binding& wanted : program.interface().bindings) {
      switch (wanted.index) {
        case glsl::kBindPositions:
          bindings.emplace_back(wanted.index, scene.positions);
          break;
        case glsl::kBindInstances:
          bindings.emplace_back(wanted.index, scene.instances);
          break;
        case glsl::kBindUvs:
          bindings.emplace_back(wanted.index, scene.uvs);
          break;
        case glsl::kBindMaterials:
          bindings.emplace_back(wanted.index, scene.materials);
          break;
        case glsl::kBindTextures:
          bindings.emplace_back(wanted.index, scene.textures);
          break;
        case glsl::kBindTexels:
          bindings.emplace_back(wanted.index, scene.texels);
          break;
        case glsl::kBindMap:
          bindings.emplace_back(wanted.index, map.uniforms());
          break;
        case glsl::kBindMapDepth:
          bindings.emplace_back(wanted.index, map.depth());
          break;
        default:
          break;  // bind() says what is missing
      }
    }
    commands.bind(program, gpu::asPush(push).first(readsFirstLayer ? sizeof(PeelPush) : sizeof(int32_t)),
                  bindings);
    commands.bindIndexBuffer(scene.triangles);
    commands.setCulling(VK_CULL_MODE_NONE, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    recordDraws(commands, scene, [&](const Draw& d) { return d.masked == masked && !culled(d); });
    for (const bool mirrored : {false, true}) {
      commands.setCulling(backFaces ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_BACK_BIT,
                          mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
      recordDraws(commands, scene,
                  [&](const Draw& d) { return d.masked == masked && d.mirrored == mirrored && culled(d); });
    }
  }
}

void MapRenderer::record(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map,
                         const LightModel& light, CullMode cull, SecondLayer method) const {
  const bool peels = method == SecondLayer::Peel && map.content() == MapContent::TwoLayers;
  if (peels && map.peelDepth_.handle() == VK_NULL_HANDLE)
    map.peelDepth_ = gpu::Image(
        device_, layersDesc("peel depth", VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                            map.depth().desc().width, static_cast<uint32_t>(map.layerCount())));
  for (int layer = 0; layer < map.layerCount(); ++layer) {
    const auto target = static_cast<uint32_t>(layer);
    commands.beginRendering({.depth = &map.depth(), .clearDepth = 1.0f, .layer = target});
    recordLayer(commands, scene, map, light, cull, first_, layer, false);
    commands.endRendering();
    if (map.content() != MapContent::TwoLayers) continue;
    commands.barrier("the first layer's depth is written -> the second layer tests against it");
    gpu::RenderTargets second{
        .colors = {{.image = &map.second_, .clear = VkClearColorValue{.float32 = {1.0f, 0.0f, 0.0f, 0.0f}}}},
        .depth = peels ? &map.peelDepth_ : &map.depth(),
        .layer = target};
    if (peels) second.clearDepth = 1.0f;
    commands.beginRendering(second);
    recordLayer(commands, scene, map, light, cull, peels ? peel_ : blend_, layer, peels);
    commands.endRendering();
  }
}

}  // namespace gnomon
