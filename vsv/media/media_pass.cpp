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

VkDeviceSize pictureBytes(int width, int height, MediaPass::Output output) {
  if (output == MediaPass::Output::Images) return 0;
  return static_cast<VkDeviceSize>(width) * static_cast<VkDeviceSize>(height) * sizeof(glm::vec3);
}

// Takes the place of vsv/store_scattered.glsl.
std::string storageIn(VkFormat format) {
  if (format != VK_FORMAT_R16G16B16A16_SFLOAT && format != VK_FORMAT_R32G32B32A32_SFLOAT)
    throw WorldError(
        fmt::format("scattered light in an image of VkFormat {}: make it R16G16B16A16_SFLOAT or R32G32B32A32_SFLOAT",
                    static_cast<int>(format)));
  return fmt::format(
      "#include \"shared/media_pass.glsl\"\n"
      "layout(binding = kBindInScattered, {}) uniform image2D inScatteredImage;\n"
      "vec3 scatteredBefore(ivec2 pixel, int width) {{ return imageLoad(inScatteredImage, pixel).xyz; }}\n"
      "void storeScattered(ivec2 pixel, int width, vec3 light) {{\n"
      "  imageStore(inScatteredImage, pixel, vec4(light, 0.0f));\n"
      "}}\n",
      format == VK_FORMAT_R16G16B16A16_SFLOAT ? "rgba16f" : "rgba32f");
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

float defaultReach(const Scene& scene, const glm::vec3& eyeW) {
  const Bounds bounds = computeBounds(scene);
  return glm::length(glm::max(glm::abs(bounds.lower - eyeW), glm::abs(bounds.upper - eyeW)));
}

MediaPass::MediaPass(const gpu::Device& device, int width, int height, Output output)
    : device_(device),
      programs_(device),
      groupCount_(groups(width, glsl::kMediaGroupSide), groups(height, glsl::kMediaGroupSide), 1),
      uniforms_(
          device,
          {.name = "media uniforms", .size = sizeof(glsl::MediaUniforms), .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}),
      receiverPicture_(device, {.name = "receiver picture",
                                .size = sizeof(glsl::ReceiverPicture),
                                .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}),
      running_(device, {.name = "running integral",
                        .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                        .width = glsl::kTableColumns,
                        .height = glsl::kTableRows,
                        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}),
      inScattered_(device, {.name = "in-scattered light", .size = pictureBytes(width, height, output)}),
      surfaces_(device, {.name = "surfaces in the medium", .size = pictureBytes(width, height, output)}),
      radiance_(device, {.name = "radiance with the medium", .size = pictureBytes(width, height, output)}) {}

void MediaPass::setMedium(const glsl::CameraView& camera, const glsl::Medium& medium, const DensityBuffers* density) {
  density_ = density;
  if (density != nullptr && lightDepth_.size() == 0) {
    constexpr int kFloats = 2 * glsl::kLightDepthRadii * glsl::kLightDepthSide * glsl::kLightDepthSide;
    lightDepth_ = gpu::Buffer(device_, {.name = "density to the light", .size = kFloats * sizeof(float)});
    eyeDepth_ = gpu::Buffer(device_, {.name = "density to the eye", .size = inScattered_.size() / 3});
  }
  gpu::upload(device_, uniforms_, gpu::asPush(glsl::MediaUniforms{.camera = camera, .medium = medium}));
}

void MediaPass::recordMedium(gpu::Commands& commands, const glsl::CameraView& camera, const glsl::Medium& medium,
                             const glsl::ReceiverPicture& meaning) {
  density_ = nullptr;
  commands.update(uniforms_, gpu::asPush(glsl::MediaUniforms{.camera = camera, .medium = medium}));
  commands.update(receiverPicture_, gpu::asPush(meaning));
  commands.barrier("the medium's numbers are written -> tables and view rays read them");
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

const gpu::ComputeProgram& MediaPass::integratorProgram(const SceneBuffers& scene, ReceiverKind receivers,
                                                        const Occluders& occluders, const MediaMethod& method,
                                                        const gpu::Image* into) const {
  std::vector<gpu::Specialization> constants = {{.id = 4, .value = scene.instanced ? 1 : 0},
                                                ReceiverPicture::constant(receivers)};
  if (method.readsDepths()) constants.push_back({.id = 0, .value = occluders.kind()});
  gpu::ShaderSource source = ReceiverPicture::shader({method.integrator->shader, {}}, receivers);
  if (into != nullptr) source.overrides["vsv/store_scattered.glsl"] = storageIn(into->desc().format);
  return programs_.get(source, constants);
}

void MediaPass::prepare(const SceneBuffers& scene, ReceiverKind receivers, const Occluders& occluders,
                        const MediaMethod& method, const gpu::Image* into) {
  if (occluders.bits() != nullptr) programs_.get("vsv/tabulate_scattering.comp.glsl");
  integratorProgram(scene, receivers, occluders, method, into);
}

void MediaPass::record(gpu::Commands& commands, const SceneBuffers& scene, const ReceiverPicture& receivers,
                       const Occluders& occluders, const MediaLightSource& light, const MediaMethod& method, bool add,
                       const gpu::Image* into) {
  GNOMON_CHECK_EQ(method.readsDepths(), occluders.bits() == nullptr);
  GNOMON_CHECK(method.steps > 0 || (!method.integrator->takesSteps && density_ == nullptr));
  std::vector<gpu::Binding> bindings = {{glsl::kBindPositions, scene.positions},
                                        {glsl::kBindTriangles, scene.triangles},
                                        {glsl::kBindInstances, scene.instances},
                                        {glsl::kBindMedia, uniforms_},
                                        into != nullptr ? gpu::Binding{glsl::kBindInScattered, *into}
                                                        : gpu::Binding{glsl::kBindInScattered, inScattered_},
                                        {glsl::kBindMap, occluders.uniforms()}};
  receivers.bind(bindings, receiverPicture_);
  const glsl::MediaPush push = pushFor(light, method, add);
  commands.beginStage("media integrate");
  if (density_ != nullptr) {
    GNOMON_CHECK(receivers.kind() == ReceiverKind::GBuffer && into == nullptr);
    recordDensity(commands, occluders, light, push, {.id = 4, .value = scene.instanced ? 1 : 0}, std::move(bindings));
  } else {
    if (method.readsDepths()) {
      bindings.emplace_back(glsl::kBindMapDepth, occluders.depth());
    } else {
      bindings.emplace_back(glsl::kBindBits, *occluders.bits());
      bindings.emplace_back(glsl::kBindRunning, running_);
    }
    const gpu::ComputeProgram& program = integratorProgram(scene, receivers.kind(), occluders, method, into);
    const bool all = receivers.kind() == ReceiverKind::GBuffer;
    commands.dispatch(program, groupCount_, gpu::asPush(push), all ? bindings : gpu::declaredBy(program, bindings));
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
