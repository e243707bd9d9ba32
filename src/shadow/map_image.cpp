#include "shadow/map_image.h"

#include "base/error.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

gpu::GraphicsDesc depthProgram(const char* name, bool masked) {
  return {.name = name,
          .vertex = {"shadow/project_to_layer.vert.glsl", {}},
          .fragment = {masked ? "shadow/draw_depth_masked.frag.glsl" : "", {}},
          .depthFormat = VK_FORMAT_D32_SFLOAT,
          .depthCompare = VK_COMPARE_OP_LESS};
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

MapImage::MapImage(const gpu::Device& device, const FittedMap& fitted)
    : depth_(device, {.name = "shadow map depth",
                      .format = VK_FORMAT_D32_SFLOAT,
                      .width = static_cast<uint32_t>(fitted.map.side),
                      .height = static_cast<uint32_t>(fitted.map.side),
                      .layerCount = static_cast<uint32_t>(fitted.map.layerCount),
                      .array = true,
                      .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}),
      uniforms_(gpu::createBufferWith(
          device, "map uniforms",
          std::vector<glsl::MapUniforms>{{.lightFrame = fitted.frame, .shadowMap = fitted.map}},
          VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)),
      layerCount_(fitted.map.layerCount),
      kind_(fitted.map.kind) {}

MapRenderer::MapRenderer(const gpu::Device& device)
    : opaque_(device, depthProgram("draw depth", false)),
      masked_(device, depthProgram("draw depth, masked", true)) {}

void MapRenderer::record(gpu::Commands& commands, const SceneBuffers& scene, const MapImage& map,
                         const LightModel& light, CullMode cull) const {
  const auto culled = [&](const Draw& draw) {
    return cull == CullMode::Solids && draw.solid && !holdsLight(draw, light);
  };
  const auto drawGroup = [&](bool masked) {
    commands.bindIndexBuffer(scene.triangles);
    commands.setCulling(VK_CULL_MODE_NONE, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    recordDraws(commands, scene, [&](const Draw& d) { return d.masked == masked && !culled(d); });
    for (const bool mirrored : {false, true}) {
      commands.setCulling(VK_CULL_MODE_BACK_BIT,
                          mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
      recordDraws(commands, scene,
                  [&](const Draw& d) { return d.masked == masked && d.mirrored == mirrored && culled(d); });
    }
  };
  const bool anyMasked = !scene.draws.empty() && scene.draws.back().masked;
  for (int layer = 0; layer < map.layerCount(); ++layer) {
    commands.beginRendering(
        {.depth = &map.depth(), .clearDepth = 1.0f, .layer = static_cast<uint32_t>(layer)});
    commands.bind(opaque_, gpu::asPush(layer),
                  {{glsl::kBindPositions, scene.positions},
                   {glsl::kBindInstances, scene.instances},
                   {glsl::kBindUvs, scene.uvs},
                   {glsl::kBindMap, map.uniforms()}});
    drawGroup(false);
    if (anyMasked) {
      commands.bind(masked_, gpu::asPush(layer),
                    {{glsl::kBindPositions, scene.positions},
                     {glsl::kBindInstances, scene.instances},
                     {glsl::kBindUvs, scene.uvs},
                     {glsl::kBindMaterials, scene.materials},
                     {glsl::kBindTextures, scene.textures},
                     {glsl::kBindTexels, scene.texels},
                     {glsl::kBindMap, map.uniforms()}});
      drawGroup(true);
    }
    commands.endRendering();
  }
}

}  // namespace gnomon
