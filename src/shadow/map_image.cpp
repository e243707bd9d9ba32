#include "shadow/map_image.h"

#include "base/error.h"
#include "shadow/layer_culling.h"
#include "shadow/visibility_pass.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

gpu::ImageDesc layersDesc(const char* name, VkFormat format, VkImageUsageFlags usage, const glsl::ShadowMap& map) {
  return {.name = name,
          .format = format,
          .width = static_cast<uint32_t>(map.side),
          .height = static_cast<uint32_t>(map.rows),
          .layerCount = static_cast<uint32_t>(map.layerCount),
          .array = true,
          .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT};
}

bool holdsLight(const Draw& draw, const LightModel& light) {
  if (light.type == LightType::Directional) return false;
  const glm::vec3 position(light.positionW);
  return glm::all(glm::greaterThanEqual(position, draw.boundsW.lower)) &&
         glm::all(glm::lessThanEqual(position, draw.boundsW.upper));
}

// What a program reads of the scene and the map.
std::vector<gpu::Binding> bindingsOf(const gpu::GraphicsProgram& program, const SceneBuffers& scene,
                                     const MapImage& map, const BoundedDraws& bounded) {
  std::vector<gpu::Binding> bindings;
  for (const gpu::ProgramInterface::Binding& wanted : program.interface().bindings) {
    switch (wanted.index) {
      case glsl::kBindPositions:
        bindings.emplace_back(wanted.index, scene.positions);
        break;
      case glsl::kBindTriangles:
        bindings.emplace_back(wanted.index, scene.triangles);
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
      case glsl::kBindBoundedTriangles:
        bindings.emplace_back(wanted.index, bounded.triangles());
        break;
      default:
        break;  // bind() says what is missing
    }
  }
  return bindings;
}

}  // namespace

MapImage::MapImage(const gpu::Device& device, const FittedMap& fitted, MapContent content)
    : Occluders(device, fitted, "map uniforms"), content_(content) {
  depth_ = gpu::Image(device, layersDesc("shadow map depth", VK_FORMAT_D32_SFLOAT,
                                         VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, fitted.map));
  if (content == MapContent::TwoLayers)
    second_ = gpu::Image(device, layersDesc("shadow map second depth", VK_FORMAT_R32_SFLOAT,
                                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, fitted.map));
}

void MapImage::recordDrawing(gpu::Commands& commands, const MapRenderer& renderer, const SceneBuffers& scene,
                             const LightModel& light, CullMode cull) {
  renderer.record(commands, scene, *this, light, cull);
}

void MapImage::recordVisibility(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                                VisibilityPass& pass, const ShadowLookup& lookup) const {
  pass.record(commands, scene, gbuffer, *this, lookup.bias, lookup.diagnose, lookup.filter);
}

std::vector<float> MapImage::downloadDepth(const gpu::Device& device) const {
  return gpu::downloadAs<float>(device, depth_);
}

std::vector<float> MapImage::downloadSecondDepth(const gpu::Device& device) const {
  if (content_ != MapContent::TwoLayers) return {};
  return gpu::downloadAs<float>(device, second_);
}

MapRenderer::MapRenderer(const gpu::Device& device) : device_(device), computePrograms_(device), bounded_(device) {}

const gpu::GraphicsProgram& MapRenderer::program(const Key& key) const {
  for (const auto& entry : programs_)
    if (entry->key == key) return entry->program;
  const LayerShaders& shaders = key.shaders;
  const bool second = key.pass != Pass::First;
  const char* fragment = key.pass == Pass::Blend  ? shaders.secondDepth
                         : key.pass == Pass::Peel ? shaders.peel
                         : key.masked             ? shaders.depthMasked
                                                  : shaders.depth;
  gpu::GraphicsDesc desc{.name = second ? "draw second depth" : "draw depth",
                         .vertex = {shaders.vertex, {}},
                         .fragment = {fragment, {}},
                         .specializations = {{.id = 0, .value = key.masked ? 1 : 0},
                                             {.id = 1, .value = static_cast<int32_t>(key.pass)},
                                             {.id = 2, .value = key.mapKind},
                                             {.id = 3, .value = key.viewMask != 0 ? 1 : 0}},
                         .depthFormat = VK_FORMAT_D32_SFLOAT,
                         .depthCompare = VK_COMPARE_OP_LESS,
                         .viewMask = key.viewMask};
  if (second) desc.colorFormats = {VK_FORMAT_R32_SFLOAT};
  if (key.pass == Pass::Blend) {
    desc.depthCompare = VK_COMPARE_OP_GREATER;
    desc.depthWrite = false;
    desc.minBlend = true;
  }
  programs_.push_back(std::make_unique<Entry>(Entry{key, gpu::GraphicsProgram(device_, desc)}));
  return programs_.back()->program;
}

void MapRenderer::recordCorners(gpu::Commands& commands, const SceneBuffers& scene, const Layer& layer,
                                const Grouping& groupOf) const {
  const LayerShaders& shaders = layer.map.fitted().shaders;
  const bool backFaces = layer.map.content() == MapContent::BackFaces;
  const bool mirrors = (shaders.mirroredLayers >> layer.index & 1u) != 0;
  const LayerPush push{.layer = layer.index};
  const LayerCulling culling(layer.map.fitted(), layer.index, layer.count);
  std::vector<std::vector<LayerCulling::Range>> shown;  // of each draw
  for (const Draw& d : scene.draws) shown.push_back(culling.rangesOf(scene, d));
  commands.beginRendering(layer.targets);
  for (const bool masked : {false, true}) {
    for (const Group group : {Group::Sheets, Group::Solids, Group::MirroredSolids}) {
      const auto wanted = [&](size_t i) {
        const Draw& d = scene.draws[i];
        return d.masked == masked && groupOf(d) == group && !shown[i].empty();
      };
      size_t next = 0;
      while (next < shown.size() && !wanted(next)) ++next;
      if (next == shown.size()) continue;
      const gpu::GraphicsProgram& drawn =
          program({shaders, layer.pass, masked, layer.map.kind(), layer.targets.viewMask});
      commands.bind(drawn, gpu::asPush(push).first(drawn.interface().pushConstantBytes),
                    bindingsOf(drawn, scene, layer.map, bounded_));
      const bool clockwise = (group == Group::MirroredSolids) != mirrors;
      commands.setCulling(group == Group::Sheets ? VK_CULL_MODE_NONE
                          : backFaces            ? VK_CULL_MODE_FRONT_BIT
                                                 : VK_CULL_MODE_BACK_BIT,
                          clockwise ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
      commands.bindIndexBuffer(scene.triangles);
      for (; next < shown.size(); ++next)
        if (wanted(next))
          for (const LayerCulling::Range& range : shown[next])
            commands.drawIndexed(range.indexCount, 1, range.firstIndex, 0, scene.draws[next].instance);
    }
  }
  commands.endRendering();
}

void MapRenderer::recordBounds(gpu::Commands& commands, const SceneBuffers& scene, const Layer& layer,
                               const Grouping& groupOf) const {
  const LayerShaders& shaders = layer.map.fitted().shaders;
  const bool backFaces = layer.map.content() == MapContent::BackFaces;
  const LayerPush push{.layer = layer.index};
  gpu::RenderTargets targets = layer.targets;
  bool cleared = false;
  const LayerCulling culling(layer.map.fitted(), layer.index, layer.count);
  for (const bool masked : {false, true}) {
    std::vector<BoundedDraws::Piece> pieces;
    for (const Draw& d : scene.draws) {
      if (d.masked != masked) continue;
      const Group group = groupOf(d);
      const int front = group == Group::Sheets ? 0 : group == Group::Solids ? 1 : -1;
      for (const LayerCulling::Range& range : culling.rangesOf(scene, d))
        pieces.push_back({range.firstIndex / 3, range.indexCount / 3, d.instance, backFaces ? -front : front});
    }
    for (const BoundedDraws::Batch& batch : BoundedDraws::batches(pieces)) {
      bounded_.record(commands, scene, layer.map.uniforms(), shaders.bounds, layer.index, batch);
      commands.beginRendering(targets);
      const gpu::GraphicsProgram& drawn = program({shaders, layer.pass, masked, layer.map.kind(), 0});
      commands.bind(drawn, gpu::asPush(push).first(drawn.interface().pushConstantBytes),
                    bindingsOf(drawn, scene, layer.map, bounded_));
      commands.drawIndirect(bounded_.arguments());
      commands.endRendering();
      cleared = true;
      targets.clearDepth.reset();
      for (gpu::ColorTarget& color : targets.colors) color.clear.reset();
      commands.barrier("triangles of this batch are drawn -> the next batch takes their place");
    }
  }
  if (cleared) return;
  commands.beginRendering(targets);
  commands.endRendering();
}

bool MapRenderer::takesMultiview(const MapImage& map) const {
  const LayerShaders& shaders = map.fitted().shaders;
  if (shaders.passes == LayerPasses::Each) return false;
  auto found = std::ranges::find(multiviewChecks_, shaders, &decltype(multiviewChecks_)::value_type::first);
  if (found == multiviewChecks_.end()) {
    const auto draw = [this](const SceneBuffers& scene, MapImage& tried, bool multiview) {
      gpu::Commands commands(device_, "multiview check");
      recordLayers(commands, scene, tried, {}, CullMode::None, SecondLayer::Blend, multiview);
      return commands.submitAndWait().wallMs;
    };
    found = multiviewChecks_.insert(found, {shaders, checkMultiview(device_, map.fitted(), draw)});
  }
  const MultiviewCheck& check = found->second;
  if (shaders.passes == LayerPasses::Multiview && !check.same)
    throw WorldError(
        fmt::format("--cube-passes multiview: device '{}' draws triangles to the wrong layers in one pass; "
                    "choose six or auto",
                    device_.info().name));
  return shaders.passes == LayerPasses::Multiview || (check.same && check.faster);
}

void MapRenderer::record(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map, const LightModel& light,
                         CullMode cull, SecondLayer method) const {
  recordLayers(commands, scene, map, light, cull, method, takesMultiview(map));
}

void MapRenderer::recordLayers(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map,
                               const LightModel& light, CullMode cull, SecondLayer method, bool multiview) const {
  const bool backFaces = map.content() == MapContent::BackFaces;
  const Grouping groupOf = [&](const Draw& draw) {
    const bool culled = (cull == CullMode::Solids || backFaces) && draw.solid && !holdsLight(draw, light);
    return !culled ? Group::Sheets : draw.mirrored ? Group::MirroredSolids : Group::Solids;
  };
  const auto recordLayer = [&](const Layer& layer) {
    if (*map.fitted().shaders.bounds == '\0')
      recordCorners(commands, scene, layer, groupOf);
    else
      recordBounds(commands, scene, layer, groupOf);
  };
  const bool peels = method == SecondLayer::Peel && map.content() == MapContent::TwoLayers;
  if (peels && map.peelDepth_.handle() == VK_NULL_HANDLE)
    map.peelDepth_ = gpu::Image(device_, layersDesc("peel depth", VK_FORMAT_D32_SFLOAT,
                                                    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, map.fitted().map));
  const int count = multiview ? map.layerCount() : 1;
  for (int layer = 0; layer < map.layerCount(); layer += count) {
    gpu::RenderTargets first{.depth = &map.depth(), .clearDepth = 1.0f};
    if (multiview)
      first.viewMask = (1u << count) - 1u;
    else
      first.layer = static_cast<uint32_t>(layer);
    recordLayer({map, layer, count, Pass::First, first});
    if (map.content() != MapContent::TwoLayers) continue;
    commands.barrier("the first layer's depth is written -> the second layer tests against it");
    gpu::RenderTargets second{
        .colors = {{.image = &map.second_, .clear = VkClearColorValue{.float32 = {1.0f, 0.0f, 0.0f, 0.0f}}}},
        .depth = peels ? &map.peelDepth_ : &map.depth(),
        .layer = first.layer,
        .viewMask = first.viewMask};
    if (peels) second.clearDepth = 1.0f;
    recordLayer({map, layer, count, peels ? Pass::Peel : Pass::Blend, second});
  }
}

}  // namespace gnomon
