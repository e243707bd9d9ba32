#include "vsv/media/media_pass.h"

#include "base/check.h"
#include "base/error.h"

#include "shared/media_pass.glsl"
#include "shared/shade.glsl"
#include "shared/volume.glsl"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

uint32_t groups(int count, int size) {
  return static_cast<uint32_t>((count + size - 1) / size);
}

VkDeviceSize pictureBytes(int width, int height) {
  return static_cast<VkDeviceSize>(width) * static_cast<VkDeviceSize>(height) * sizeof(glm::vec3);
}

glsl::MediaPush pushFor(const MediaLightSource& light, const MediaMethod& method, bool add) {
  return {.lightW = glm::vec3(light.positionW),
          .intensity = light.intensity,
          .coneAxisW = glm::vec3(light.coneAxisW),
          .coneCos = static_cast<float>(light.coneCos),
          .steps = method.steps,
          .add = add ? 1 : 0};
}

}  // namespace

MediaLightSource mediaLight(const Light& light) {
  if (light.type == LightType::Directional)
    throw WorldError(
        fmt::format("the light '{}' is directional, and gnomon fog supports point and spot lights only; choose another "
                    "with --light",
                    light.name));
  MediaLightSource source{.positionW = glm::dvec3(light.positionW), .intensity = light.color * light.intensity};
  if (light.type == LightType::Spot) {
    source.coneAxisW = glm::normalize(glm::dvec3(light.directionW));
    source.coneCos = std::max(std::cos(static_cast<double>(light.outerConeRad)), 0.0);
  }
  return source;
}

std::vector<glm::dvec3> mediaReceiversW(const glsl::CameraView& camera, const Receivers& receivers, double reach) {
  const glm::dvec3 eyeW(camera.eyeW);
  std::vector<glm::dvec3> ends(receivers.states.size() + 1, eyeW);
  for (size_t i = 0; i < receivers.states.size(); ++i) {
    const int x = static_cast<int>(i) % receivers.width, y = static_cast<int>(i) / receivers.width;
    const glm::dvec3 dir = glm::normalize(glm::dvec3(glsl::pixelDirection(camera, x, y)));
    double end = reach;
    if (receivers.states[i] != PixelState::Empty)
      end = std::min(end, glm::dot(receivers.samples[i].positionW - eyeW, dir));
    ends[i] = eyeW + dir * end;
  }
  return ends;
}

float defaultReach(const Scene& scene, const glm::vec3& eyeW) {
  const Bounds bounds = computeBounds(scene);
  return glm::length(glm::max(glm::abs(bounds.lower - eyeW), glm::abs(bounds.upper - eyeW)));
}

MediaPass::MediaPass(const gpu::Device& device, int width, int height)
    : device_(device),
      programs_(device),
      groupCount_(groups(width, glsl::kMediaGroupSide), groups(height, glsl::kMediaGroupSide), 1),
      uniforms_(
          device,
          {.name = "media uniforms", .size = sizeof(glsl::MediaUniforms), .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}),
      running_(device, {.name = "running integral",
                        .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                        .width = glsl::kTableColumns,
                        .height = glsl::kTableRows,
                        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}),
      inScattered_(device, {.name = "in-scattered light", .size = pictureBytes(width, height)}),
      surfaces_(device, {.name = "surfaces in the medium", .size = pictureBytes(width, height)}),
      radiance_(device, {.name = "radiance with the medium", .size = pictureBytes(width, height)}) {}

void MediaPass::setMedium(const glsl::CameraView& camera, const glsl::Medium& medium, const DensityBuffers* density) {
  density_ = density;
  if (density != nullptr && lightDepth_.size() == 0) {
    constexpr int kFloats = 2 * glsl::kLightDepthRadii * glsl::kLightDepthSide * glsl::kLightDepthSide;
    lightDepth_ = gpu::Buffer(device_, {.name = "density to the light", .size = kFloats * sizeof(float)});
    eyeDepth_ = gpu::Buffer(device_, {.name = "density to the eye", .size = inScattered_.size() / 3});
  }
  gpu::upload(device_, uniforms_, gpu::asPush(glsl::MediaUniforms{.camera = camera, .medium = medium}));
}

void MediaPass::recordTable(gpu::Commands& commands, const Occluders& occluders, const MediaLightSource& light) {
  commands.beginStage("media table");
  if (density_ != nullptr) {
    const glsl::DensityPush push{.light = pushFor(light, {}, false),
                                 .reach = lightReach(density_->boundsW, density_->voxelMetres, light.positionW)};
    const uint32_t side = groups(glsl::kLightDepthSide, glsl::kMediaGroupSide);
    commands.dispatch(programs_.get("vsv/tabulate_light_depth.comp.glsl"),
                      {side, side, static_cast<uint32_t>(push.reach.layers)}, gpu::asPush(push),
                      {{glsl::kBindDensity, density_->words},
                       {glsl::kBindDensityPlace, density_->place},
                       {glsl::kBindLightDepth, lightDepth_}});
  } else if (occluders.bits() != nullptr) {
    commands.dispatch(
        programs_.get("vsv/tabulate_scattering.comp.glsl"), {groups(glsl::kTableRows, glsl::kTableGroupSize), 1, 1}, {},
        {{glsl::kBindMap, occluders.uniforms()}, {glsl::kBindMedia, uniforms_}, {glsl::kBindRunning, running_}});
  }
  commands.endStage();
}

void MediaPass::record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                       const Occluders& occluders, const MediaLightSource& light, const MediaMethod& method, bool add) {
  GNOMON_CHECK_EQ(method.readsDepths(), occluders.bits() == nullptr);
  GNOMON_CHECK(method.steps > 0 || (!method.integrator->takesSteps && density_ == nullptr));
  std::vector<gpu::Binding> bindings = {
      {glsl::kBindPositions, scene.positions}, {glsl::kBindTriangles, scene.triangles},
      {glsl::kBindInstances, scene.instances}, {glsl::kBindPrimitiveIds, gbuffer.primitiveIds()},
      {glsl::kBindMedia, uniforms_},           {glsl::kBindInScattered, inScattered_},
      {glsl::kBindMap, occluders.uniforms()}};
  const glsl::MediaPush push = pushFor(light, method, add);
  const gpu::Specialization instanced{.id = 4, .value = scene.instanced ? 1 : 0};
  commands.beginStage("media integrate");
  if (density_ != nullptr) {
    recordDensity(commands, occluders, light, push, instanced, std::move(bindings));
  } else {
    std::vector<gpu::Specialization> constants = {instanced};
    if (method.readsDepths()) {
      constants.push_back({.id = 0, .value = occluders.kind()});
      bindings.emplace_back(glsl::kBindMapDepth, occluders.depth());
    } else {
      bindings.emplace_back(glsl::kBindBits, *occluders.bits());
      bindings.emplace_back(glsl::kBindRunning, running_);
    }
    commands.dispatch(programs_.get(method.integrator->shader, constants), groupCount_, gpu::asPush(push), bindings);
  }
  commands.endStage();
}

// Of bits and depths one is bound and not read.
void MediaPass::recordDensity(gpu::Commands& commands, const Occluders& occluders, const MediaLightSource& light,
                              const glsl::MediaPush& lightPush, const gpu::Specialization& instanced,
                              std::vector<gpu::Binding> bindings) {
  bindings.emplace_back(glsl::kBindMapDepth, occluders.depth());
  bindings.emplace_back(glsl::kBindBits, occluders.bits() != nullptr ? *occluders.bits() : lightDepth_);
  bindings.emplace_back(glsl::kBindDensity, density_->words);
  bindings.emplace_back(glsl::kBindDensityPlace, density_->place);
  bindings.emplace_back(glsl::kBindLightDepth, lightDepth_);
  bindings.emplace_back(glsl::kBindEyeDepth, eyeDepth_);
  const glsl::DensityPush push{.light = lightPush,
                               .reach = lightReach(density_->boundsW, density_->voxelMetres, light.positionW)};
  commands.dispatch(programs_.get("vsv/march_density.comp.glsl", {{.id = 0, .value = occluders.kind()}, instanced}),
                    groupCount_, gpu::asPush(push), bindings);
}

void MediaPass::recordSurfaces(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                               const MediaLightSource& light, const gpu::Buffer& shade, const gpu::Buffer& visibility,
                               bool add) {
  glsl::DensityPush push{.light = pushFor(light, {}, add), .reach = {}};
  std::vector<gpu::Binding> bindings = {{glsl::kBindPositions, scene.positions},
                                        {glsl::kBindTriangles, scene.triangles},
                                        {glsl::kBindInstances, scene.instances},
                                        {glsl::kBindUvs, scene.uvs},
                                        {glsl::kBindNormals, scene.normals},
                                        {glsl::kBindMaterials, scene.materials},
                                        {glsl::kBindTextures, scene.textures},
                                        {glsl::kBindTexels, scene.texels},
                                        {glsl::kBindPrimitiveIds, gbuffer.primitiveIds()},
                                        {glsl::kBindShade, shade},
                                        {glsl::kBindVisibility, visibility},
                                        {glsl::kBindMedia, uniforms_},
                                        {glsl::kBindSurface, surfaces_}};
  // Homogeneous: some buffer is bound in their place and not read.
  bindings.emplace_back(glsl::kBindLightDepth, density_ != nullptr ? lightDepth_ : visibility);
  bindings.emplace_back(glsl::kBindEyeDepth, density_ != nullptr ? eyeDepth_ : visibility);
  if (density_ != nullptr) push.reach = lightReach(density_->boundsW, density_->voxelMetres, light.positionW);
  commands.beginStage("media surfaces");
  commands.dispatch(
      programs_.get("vsv/shade_surface_in_medium.comp.glsl", {{.id = 0, .value = density_ != nullptr ? 1 : 0},
                                                              {.id = 4, .value = scene.instanced ? 1 : 0},
                                                              {.id = 8, .value = scene.textured ? 1 : 0}}),
      groupCount_, gpu::asPush(push), bindings);
  commands.endStage();
}

void MediaPass::recordSum(gpu::Commands& commands) {
  commands.dispatch(programs_.get("vsv/add_scattered_light.comp.glsl"), groupCount_, {},
                    {{glsl::kBindMedia, uniforms_},
                     {glsl::kBindInScattered, inScattered_},
                     {glsl::kBindSurface, surfaces_},
                     {glsl::kBindMediaRadiance, radiance_}});
}

}  // namespace gnomon
