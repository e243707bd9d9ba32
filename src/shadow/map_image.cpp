#include "shadow/map_image.h"

#include "base/check.h"
#include "base/error.h"
#include "shadow/decision_pass.h"
#include "shadow/frame_pass.h"
#include "shadow/slice_culling.h"
#include "shadow/visibility_pass.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

gpu::ImageDesc slicesDesc(const char* name, VkFormat format, VkImageUsageFlags usage, const glsl::ShadowMap& map) {
  return {.name = name,
          .format = format,
          .width = static_cast<uint32_t>(map.width),
          .height = static_cast<uint32_t>(map.height),
          .layerCount = static_cast<uint32_t>(map.sliceCount),
          .array = true,
          .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT};
}

bool hasTwoLayers(ChannelSet channels) {
  return (channels & glsl::kChannelSecondDepth) != 0;
}

SecondLayer chosenSecondLayer(const gpu::Device& device, ChannelSet channels, std::optional<SecondLayer> wanted) {
  if (wanted == SecondLayer::Ordered) GNOMON_CHECK(device.info().orderedAttachmentAccess);
  const SecondLayer fastest = device.info().orderedAttachmentAccess ? SecondLayer::Ordered : SecondLayer::Blend;
  const SecondLayer chosen = wanted.value_or(fastest);
  return chosen == SecondLayer::Blend && !blends(channels) ? SecondLayer::Peel : chosen;
}

bool holdsLight(const Draw& draw, const LightModel& light) {
  if (light.type == LightType::Directional) return false;
  const glm::vec3 position(light.positionW);
  return glm::all(glm::greaterThanEqual(position, draw.boundsW.lower)) &&
         glm::all(glm::lessThanEqual(position, draw.boundsW.upper));
}

// What a program reads of the scene and the map.
std::vector<gpu::Binding> bindingsOf(const gpu::GraphicsProgram& program, const SceneBuffers& scene,
                                     const MapImage& map, const BoundedDraws& bounded, int slice) {
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
      case glsl::kBindIds:
        if (wanted.type == VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT)
          bindings.emplace_back(wanted.index, map.inOrder(wanted.index), static_cast<uint32_t>(slice));
        else
          bindings.emplace_back(wanted.index, map.imageOrAny(glsl::kChannelDepth));
        break;
      case glsl::kBindBoundedTriangles:
        bindings.emplace_back(wanted.index, bounded.triangles());
        break;
      case glsl::kBindBoundedDraw:
        bindings.emplace_back(wanted.index, bounded.arguments());
        break;
      default:
        break;  // bind() says what is missing
    }
  }
  return bindings;
}

}  // namespace

MapImage::MapImage(const gpu::Device& device, const FittedMap& fitted, ChannelSet wanted,
                   std::optional<SecondLayer> second)
    : Occluders(device, fitted, "map uniforms"),
      channels_(completed(wanted)),
      second_(chosenSecondLayer(device, channels_, second)) {
  ChannelSet alone = channels_;
  if (drawsInOrder()) {
    alone &= ~writtenBy(ChannelPass::Both, channels_);
    const auto draw = [&](gpu::Image& pair, const char* name, VkFormat format) {
      pair = gpu::Image(
          device, slicesDesc(name, format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT,
                             fitted.map));
    };
    const auto show = [&](ChannelSet channel, const gpu::Image& pair, VkFormat format, int component) {
      if ((channels_ & channel) == 0) return;
      const auto found = std::ranges::find(gnomon::channels(), channel, &Channel::bit);
      images_.emplace_back(channel, gpu::Image(device, found->name, pair, format, component));
    };
    draw(depthsInOrder_, "two depths", VK_FORMAT_R32G32_SFLOAT);
    show(glsl::kChannelDepth, depthsInOrder_, VK_FORMAT_R32_SFLOAT, 0);
    show(glsl::kChannelSecondDepth, depthsInOrder_, VK_FORMAT_R32_SFLOAT, 1);
    const bool secondIds = (channels_ & glsl::kChannelSecondIds) != 0;
    if (secondIds || (channels_ & glsl::kChannelIds) != 0)
      draw(idsInOrder_, "ids of two depths", VK_FORMAT_R32G32_UINT);
    show(glsl::kChannelIds, idsInOrder_, VK_FORMAT_R32_UINT, 0);
    show(glsl::kChannelSecondIds, idsInOrder_, VK_FORMAT_R32_UINT, 1);
  }
  for (const Channel& channel : gnomon::channels()) {
    if ((alone & channel.bit) == 0) continue;
    const VkImageUsageFlags usage = channel.location == kDepthBuffer ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                                                     : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    images_.emplace_back(channel.bit, gpu::Image(device, slicesDesc(channel.name, channel.format, usage, fitted.map)));
  }
}

const gpu::Image& MapImage::inOrder(uint32_t binding) const {
  const bool ids = binding == glsl::kBindIds && idsInOrder_.handle() != VK_NULL_HANDLE;
  return ids ? idsInOrder_ : depthsInOrder_;
}

bool MapImage::drawsInOrder() const {
  return hasTwoLayers(channels_) && second_ == SecondLayer::Ordered;
}

const gpu::Image& MapImage::image(ChannelSet channel) const {
  GNOMON_CHECK((channels_ & channel) != 0);
  return imageOrAny(channel);
}

const gpu::Image& MapImage::imageOrAny(ChannelSet channel) const {
  const auto found = std::ranges::find(images_, channel, &decltype(images_)::value_type::first);
  return found == images_.end() ? images_.front().second : found->second;
}

void MapImage::recordDrawing(gpu::Commands& commands, const MapRenderer& renderer, const SceneBuffers& scene,
                             const LightModel& light, CullMode cull) {
  renderer.record(commands, scene, *this, light, cull);
}

void MapImage::recordVisibility(gpu::Commands& commands, const SceneBuffers& scene, const ReceiverPicture& receivers,
                                VisibilityPass& pass, const ShadowLookup& lookup) const {
  pass.record(commands, scene, receivers, *this, lookup);
}

bool MapImage::recordDecisions(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                               DecisionPass& pass, std::span<const BiasMethod* const> biases,
                               std::span<const glsl::BiasParams> params, const glsl::ShadeUniforms& shade) const {
  pass.record(commands, scene, gbuffer, *this, biases, params, shade);
  return true;
}

bool MapImage::recordFrame(gpu::Commands& commands, const SceneBuffers& scene, FramePass& pass,
                           const ShadowLookup& lookup, const glsl::ShadeUniforms& shade) const {
  // What those read beside the map is bound by the visibility pass alone.
  if (lookup.bias.knowsSurfaces() || (lookup.bias.channels & (glsl::kChannelIds | glsl::kChannelSecondIds)) != 0)
    return false;
  pass.record(commands, scene, *this, lookup.bias, lookup.filter, shade);
  return true;
}

std::vector<float> MapImage::downloadDepth(const gpu::Device& device) const {
  return gpu::downloadAs<float>(device, depth());
}

std::vector<uint32_t> MapImage::downloadIds(const gpu::Device& device) const {
  if ((channels_ & glsl::kChannelIds) == 0) return {};
  return gpu::downloadAs<uint32_t>(device, image(glsl::kChannelIds));
}

std::vector<float> MapImage::downloadSecondDepth(const gpu::Device& device) const {
  if ((channels_ & glsl::kChannelSecondDepth) == 0) return {};
  return gpu::downloadAs<float>(device, secondDepth());
}

MapRenderer::MapRenderer(const gpu::Device& device) : device_(device), computePrograms_(device), bounded_(device) {}

MapRenderer::Key MapRenderer::keyOf(const Slice& slice, bool masked, const VertexSource* source) const {
  Key key{.shaders = slice.map.fitted().shaders,
          .pass = slice.shaderPass,
          .masked = masked,
          .mapKind = slice.map.kind(),
          .viewMask = slice.targets.viewMask,
          .stored = writtenBy(slice.pass, slice.map.channels())};
  if (source != nullptr) key.vertexStreams.push_back({.format = source->format, .stride = source->stride});
  for (const gpu::ColorTarget& color : slice.targets.colors)
    key.colorFormats.push_back(color.image != nullptr ? color.image->desc().format : VK_FORMAT_UNDEFINED);
  return key;
}

const gpu::GraphicsProgram& MapRenderer::program(const Key& key) const {
  for (const auto& entry : programs_)
    if (entry->key == key) return entry->program;
  // Stands for shadow/store_channels.glsl.
  static const std::map<std::string, std::string> kStoreInOrder = {
      {"shadow/store_channels.glsl", "#include \"shadow/store_in_order.glsl\"\n"}};
  static const std::map<std::string, std::string> kAttributes = {
      {"shadow/vertex_position.glsl", "#include \"shadow/vertex_attribute.glsl\"\n"}};
  gpu::GraphicsDesc desc{
      .name = key.ordered()                    ? "draw two depths"
              : key.pass == glsl::kPassNearest ? "draw depth"
                                               : "draw second depth",
      .vertex = {key.shaders.vertex, key.vertexStreams.empty() ? decltype(kAttributes){} : kAttributes},
      .fragment = {.path = key.needsFragments() ? key.shaders.fragment : "",
                   .overrides = key.ordered() ? kStoreInOrder : decltype(kStoreInOrder){}},
      .specializations = {{.id = 0, .value = key.masked ? 1 : 0},
                          {.id = 1, .value = key.pass},
                          {.id = 2, .value = key.mapKind},
                          {.id = 3, .value = key.viewMask != 0 ? 1 : 0},
                          {.id = 4, .value = key.stored}},
      .colorFormats = key.colorFormats,
      .depthFormat = key.ordered() ? VK_FORMAT_UNDEFINED : VK_FORMAT_D32_SFLOAT,
      .depthCompare = VK_COMPARE_OP_LESS,
      .viewMask = key.viewMask,
      .ordered = key.ordered(),
      .vertexStreams = key.vertexStreams};
  if (key.pass == glsl::kPassBlend) {
    desc.depthCompare = VK_COMPARE_OP_GREATER;
    desc.depthWrite = false;
    desc.minBlend = true;
  }
  desc.depthClamp = true;  // a caster before the near end still casts a shadow
  programs_.push_back(std::make_unique<Entry>(Entry{key, gpu::GraphicsProgram(device_, desc)}));
  return programs_.back()->program;
}

void MapRenderer::recordCorners(gpu::Commands& commands, const SceneBuffers& scene, const Slice& slice,
                                const Grouping& groupOf) const {
  const SliceShaders& shaders = slice.map.fitted().shaders;
  const bool backFaces = slice.pass == ChannelPass::BackFaces;
  const bool mirrors = (shaders.mirroredSlices >> slice.index & 1u) != 0;
  SlicePush push{.slice = slice.index};
  const SliceCulling culling(slice.map.fitted(), slice.index, slice.count);
  std::vector<std::vector<SliceCulling::Range>> shown;  // of each draw
  for (const Draw& d : scene.draws) shown.push_back(culling.rangesOf(scene, d));
  commands.beginRendering(slice.targets);
  for (const bool masked : {false, true}) {
    for (const Group group : {Group::Sheets, Group::Solids, Group::MirroredSolids}) {
      const auto wanted = [&](size_t i) {
        const Draw& d = scene.draws[i];
        return d.masked == masked && groupOf(d) == group && !shown[i].empty();
      };
      size_t next = 0;
      while (next < shown.size() && !wanted(next)) ++next;
      if (next == shown.size()) continue;
      std::optional<Key> key;  // of the program that is bound
      const gpu::GraphicsProgram* drawn = nullptr;
      const VertexSource* source = nullptr;
      const auto pushed = [&] { return gpu::asPush(push).first(drawn->interface().pushConstantBytes); };
      const auto bind = [&](const VertexSource* from) {
        const Key other = keyOf(slice, masked, from);
        if (key != other) {
          key = other;
          drawn = &program(other);
          commands.bind(*drawn, pushed(), bindingsOf(*drawn, scene, slice.map, bounded_, slice.index));
        }
        source = from;
        if (from == nullptr) {
          commands.bindIndexBuffer(scene.triangles);
          return;
        }
        commands.bindVertexStream(from->vertices, from->vertexOffset);
        commands.bindIndexBuffer(from->indices, from->indexOffset, from->indexType);
      };
      const bool clockwise = (group == Group::MirroredSolids) != mirrors;
      commands.setCulling(group == Group::Sheets ? VK_CULL_MODE_NONE
                          : backFaces            ? VK_CULL_MODE_FRONT_BIT
                                                 : VK_CULL_MODE_BACK_BIT,
                          clockwise ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
      for (; next < shown.size(); ++next) {
        if (!wanted(next)) continue;
        if (!key || source != scene.draws[next].source) bind(scene.draws[next].source);
        const uint32_t sourceFirst = source != nullptr ? source->firstIndex : 0;
        for (const SliceCulling::Range& range : shown[next]) {
          push.rangeTriangle = range.firstIndex / 3;
          push.rangeId = triangleId(scene, scene.draws[next].instance, push.rangeTriangle);
          if (key->needsFragments()) commands.push(*drawn, pushed());
          commands.drawIndexed(range.indexCount, 1, range.firstIndex - sourceFirst, 0, scene.draws[next].instance);
        }
      }
    }
  }
  commands.endRendering();
}

void MapRenderer::recordBounds(gpu::Commands& commands, const SceneBuffers& scene, const Slice& slice,
                               const Grouping& groupOf) const {
  const SliceShaders& shaders = slice.map.fitted().shaders;
  const bool backFaces = slice.pass == ChannelPass::BackFaces;
  const SlicePush push{.slice = slice.index};
  gpu::RenderTargets targets = slice.targets;
  bool cleared = false;
  const SliceCulling culling(slice.map.fitted(), slice.index, slice.count);
  for (const bool masked : {false, true}) {
    std::vector<BoundedDraws::Piece> pieces;
    for (const Draw& d : scene.draws) {
      if (d.masked != masked) continue;
      const Group group = groupOf(d);
      const int front = group == Group::Sheets ? 0 : group == Group::Solids ? 1 : -1;
      for (const SliceCulling::Range& range : culling.rangesOf(scene, d))
        pieces.push_back({.firstTriangle = range.firstIndex / 3,
                          .triangleCount = range.indexCount / 3,
                          .instance = d.instance,
                          .firstId = triangleId(scene, d.instance, range.firstIndex / 3),
                          .facing = backFaces ? -front : front});
    }
    for (const BoundedDraws::Batch& batch : BoundedDraws::batches(pieces)) {
      bounded_.record(commands, scene, slice.map.uniforms(), shaders, slice.index, batch);
      commands.beginRendering(targets);
      const gpu::GraphicsProgram& drawn = program(keyOf(slice, masked, nullptr));
      commands.bind(drawn, gpu::asPush(push).first(drawn.interface().pushConstantBytes),
                    bindingsOf(drawn, scene, slice.map, bounded_, slice.index));
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
  const SliceShaders& shaders = map.fitted().shaders;
  if (shaders.passes == SlicePasses::Each) return false;
  auto found = std::ranges::find(multiviewChecks_, shaders, &decltype(multiviewChecks_)::value_type::first);
  if (found == multiviewChecks_.end()) {
    const auto draw = [this](const SceneBuffers& scene, MapImage& tried, bool multiview) {
      gpu::Commands commands(device_, "multiview check");
      recordSlices(commands, scene, tried, {}, CullMode::None, multiview);
      return commands.submitAndWait().wallMs;
    };
    found = multiviewChecks_.insert(found, {shaders, checkMultiview(device_, map.fitted(), draw)});
  }
  const MultiviewCheck& check = found->second;
  if (shaders.passes == SlicePasses::Multiview && !check.same)
    throw WorldError(
        fmt::format("--cube-passes multiview: device '{}' draws triangles to the wrong slices in one pass; "
                    "choose six or auto",
                    device_.info().name));
  return shaders.passes == SlicePasses::Multiview || (check.same && check.faster);
}

void MapRenderer::record(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map, const LightModel& light,
                         CullMode cull) const {
  recordSlices(commands, scene, map, light, cull, takesMultiview(map) && !map.drawsInOrder());
}

gpu::RenderTargets MapRenderer::targetsOf(MapImage& map, ChannelPass pass) const {
  gpu::RenderTargets targets;
  if (pass == ChannelPass::Both) {
    targets.ordered = true;
    targets.kept = &map.orderedTargets_;
    targets.colors.push_back({.image = &map.depthsInOrder_, .clear = {{.float32 = {1.0f, 1.0f, 0.0f, 0.0f}}}});
    if (map.idsInOrder_.handle() != VK_NULL_HANDLE)
      targets.colors.push_back({.image = &map.idsInOrder_, .clear = {{.uint32 = {0, 0, 0, 0}}}});
    return targets;
  }
  for (const Channel& channel : channels()) {
    if ((writtenBy(pass, map.channels()) & channel.bit) == 0) continue;
    if (channel.location == kDepthBuffer) {
      targets.depth = &map.image(channel.bit);
      targets.clearDepth = 1.0f;
      continue;
    }
    if (std::ssize(targets.colors) <= channel.location) targets.colors.resize(channel.location + 1);
    targets.colors[channel.location] = {.image = &map.image(channel.bit), .clear = channel.clear};
  }
  if (pass != ChannelPass::Second) return targets;
  if (map.second_ == SecondLayer::Blend) {
    targets.depth = &map.depth();  // tested against, and kept
    return targets;
  }
  if (map.peelDepth_.handle() == VK_NULL_HANDLE)
    map.peelDepth_ = gpu::Image(device_, slicesDesc("peel depth", VK_FORMAT_D32_SFLOAT,
                                                    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, map.fitted().map));
  targets.depth = &map.peelDepth_;
  targets.clearDepth = 1.0f;
  return targets;
}

// In the order in which a slice is drawn.
std::vector<ChannelPass> MapRenderer::passesOf(const MapImage& map) const {
  const auto writes = [&](ChannelPass pass) { return writtenBy(pass, map.channels()) != 0; };
  std::vector<ChannelPass> passes;
  if (map.drawsInOrder()) {
    passes.push_back(ChannelPass::Both);
  } else {
    if (writes(ChannelPass::Nearest)) passes.push_back(ChannelPass::Nearest);
    if (writes(ChannelPass::Second)) passes.push_back(ChannelPass::Second);
  }
  if (writes(ChannelPass::BackFaces)) passes.push_back(ChannelPass::BackFaces);
  return passes;
}

MapRenderer::Slice MapRenderer::sliceOf(MapImage& map, int first, int count, ChannelPass pass) const {
  const int shaderPass = pass == ChannelPass::Both           ? glsl::kPassOrdered
                         : pass != ChannelPass::Second       ? glsl::kPassNearest
                         : map.second_ == SecondLayer::Blend ? glsl::kPassBlend
                                                             : glsl::kPassPeel;
  Slice slice{map, first, count, pass, shaderPass, targetsOf(map, pass)};
  if (count > 1)
    slice.targets.viewMask = (1u << count) - 1u;
  else
    slice.targets.layer = static_cast<uint32_t>(first);
  return slice;
}

void MapRenderer::recordSlices(gpu::Commands& commands, const SceneBuffers& scene, MapImage& map,
                               const LightModel& light, CullMode cull, bool multiview) const {
  const int count = multiview ? map.sliceCount() : 1;
  const std::vector<ChannelPass> passes = passesOf(map);
  for (int first = 0; first < map.sliceCount(); first += count) {
    for (const ChannelPass pass : passes) {
      if (pass == ChannelPass::Second)
        commands.barrier("the first layer's depth is written -> the second layer tests against it");
      const bool backFaces = pass == ChannelPass::BackFaces;
      const Grouping groupOf = [&](const Draw& draw) {
        const bool culled = (cull == CullMode::Solids || backFaces) && draw.solid && !holdsLight(draw, light);
        return !culled ? Group::Sheets : draw.mirrored ? Group::MirroredSolids : Group::Solids;
      };
      const Slice slice = sliceOf(map, first, count, pass);
      if (*map.fitted().shaders.bounds == '\0')
        recordCorners(commands, scene, slice, groupOf);
      else
        recordBounds(commands, scene, slice, groupOf);
    }
  }
}

void MapRenderer::recordDrawnBy(gpu::Commands& commands, MapImage& map, const DrawSlice& draw) const {
  const FittedMap& fitted = map.fitted();
  GNOMON_CHECK(fitted.shaders.projective && fitted.shaders.rasterizedDepth);
  GNOMON_CHECK_EQ(map.channels() & ~(glsl::kChannelDepth | glsl::kChannelIds), 0);
  glm::mat4 lightFromWorld(glm::transpose(glm::mat3(fitted.frame.rightW, fitted.frame.upW, fitted.frame.backW)));
  lightFromWorld[3] = glm::vec4(-(glm::mat3(lightFromWorld) * fitted.frame.originW), 1.0f);
  for (int i = 0; i < map.sliceCount(); ++i) {
    const Slice slice = sliceOf(map, i, 1, ChannelPass::Nearest);
    commands.beginRendering(slice.targets);
    draw(commands.handle(),
         {.slice = i,
          .side = fitted.map.width,
          .clipFromWorld = fitted.map.mapSlices[i].clipFromLight * lightFromWorld,
          .mirrors = (fitted.shaders.mirroredSlices >> i & 1u) != 0,
          .idFormat = (map.channels() & glsl::kChannelIds) != 0 ? VK_FORMAT_R32_UINT : VK_FORMAT_UNDEFINED});
    commands.endRendering();
  }
}

void MapRenderer::prepare(const SceneBuffers& scene, MapImage& map) const {
  const SliceShaders& shaders = map.fitted().shaders;
  const bool bounds = *shaders.bounds != '\0';
  uint64_t triangles = 0;
  for (const Draw& draw : scene.draws) triangles += draw.indexCount / 3;
  if (bounds) bounded_.prepare(shaders, triangles);
  for (const ChannelPass pass : passesOf(map)) {
    const Slice any = sliceOf(map, 0, 1, pass);
    for (const Draw& draw : scene.draws) program(keyOf(any, draw.masked, bounds ? nullptr : draw.source));
    for (int i = 0; pass == ChannelPass::Both && i < map.sliceCount(); ++i) {
      Slice slice = sliceOf(map, i, 1, pass);
      makeOrdered(device_, slice.targets, map.orderedTargets_);
      for (gpu::ColorTarget& color : slice.targets.colors) color.clear.reset();
      if (bounds) makeOrdered(device_, slice.targets, map.orderedTargets_);  // of a second batch
    }
  }
}

}  // namespace gnomon
