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

constexpr std::array<const char*, 4> kIntegratorNames = {"runs", "bits", "popcount", "march"};

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

int32_t bitsIntegrator(Integrator integrator) {
  switch (integrator) {
    case Integrator::Runs:
      return glsl::kIntegrateRuns;
    case Integrator::Bits:
      return glsl::kIntegrateBits;
    default:
      return glsl::kIntegratePopcount;
  }
}

}  // namespace

Integrator parseIntegrator(const std::string& name) {
  const auto found = std::ranges::find(kIntegratorNames, name);
  if (found == kIntegratorNames.end())
    throw UsageError(fmt::format("--integrators {}: choose of {}", name, fmt::join(kIntegratorNames, ", ")));
  return static_cast<Integrator>(found - kIntegratorNames.begin());
}

const char* integratorName(Integrator integrator) {
  return kIntegratorNames[static_cast<size_t>(integrator)];
}

MediaLightSource mediaLight(const Light& light) {
  if (light.type == LightType::Directional)
    throw WorldError(fmt::format(
        "the light '{}' is directional, and shafts are made of point and spot lights; choose another with "
        "--light",
        light.name));
  MediaLightSource source{.positionW = glm::dvec3(light.positionW),
                          .intensity = light.color * light.intensity};
  if (light.type == LightType::Spot) {
    source.coneAxisW = glm::normalize(glm::dvec3(light.directionW));
    source.coneCos = std::max(std::cos(static_cast<double>(light.outerConeRad)), 0.0);
  }
  return source;
}

std::vector<glm::dvec3> mediaReceiversW(const glsl::CameraView& camera, const Receivers& receivers,
                                        double reach) {
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
      groupCount_(groups(width, glsl::kMediaGroupSide), groups(height, glsl::kMediaGroupSide), 1),
      uniforms_(device, {.name = "media uniforms",
                         .size = sizeof(glsl::MediaUniforms),
                         .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}),
      running_(device, {.name = "running integral",
                        .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                        .width = glsl::kTableColumns,
                        .height = glsl::kTableRows,
                        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}),
      inScattered_(device, {.name = "in-scattered light", .size = pictureBytes(width, height)}),
      surfaces_(device, {.name = "surfaces in the medium", .size = pictureBytes(width, height)}),
      radiance_(device, {.name = "radiance with the medium", .size = pictureBytes(width, height)}) {}

const gpu::ComputeProgram& MediaPass::program(const char* shader,
                                              const std::vector<gpu::Specialization>& constants) {
  const auto same = [](const gpu::Specialization& a, const gpu::Specialization& b) {
    return a.id == b.id && a.value == b.value;
  };
  for (const auto& variant : variants_)
    if (variant->shader == shader && std::ranges::equal(variant->constants, constants, same))
      return variant->program;
  variants_.push_back(
      std::make_unique<Variant>(Variant{shader, constants, {device_, {shader, {}}, constants}}));
  return variants_.back()->program;
}

void MediaPass::setMedium(const glsl::CameraView& camera, const glsl::Medium& medium) {
  gpu::upload(device_, uniforms_, gpu::asPush(glsl::MediaUniforms{.camera = camera, .medium = medium}));
}

void MediaPass::recordTable(gpu::Commands& commands, const MediaVisibility& visibility) {
  if (visibility.volume == nullptr) return;
  commands.beginStage("media table");
  commands.dispatch(program("vsv/tabulate_scattering.comp.glsl", {}),
                    {groups(glsl::kTableRows, glsl::kTableGroupSize), 1, 1}, {},
                    {{glsl::kBindMap, visibility.volume->uniforms()},
                     {glsl::kBindMedia, uniforms_},
                     {glsl::kBindRunning, running_}});
  commands.endStage();
}

void MediaPass::record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                       const MediaVisibility& visibility, const MediaLightSource& light,
                       const MediaMethod& method, bool add) {
  const glsl::MediaPush push = pushFor(light, method, add);
  const int32_t instanced = scene.instanced ? 1 : 0;
  std::vector<gpu::Binding> bindings = {
      {glsl::kBindPositions, scene.positions}, {glsl::kBindTriangles, scene.triangles},
      {glsl::kBindInstances, scene.instances}, {glsl::kBindPrimitiveIds, gbuffer.primitiveIds()},
      {glsl::kBindMedia, uniforms_},           {glsl::kBindInScattered, inScattered_}};
  commands.beginStage("media integrate");
  if (method.integrator == Integrator::March) {
    GNOMON_CHECK(visibility.map != nullptr);
    GNOMON_CHECK_LT(0, method.steps);
    bindings.insert(bindings.end(), {{glsl::kBindMap, visibility.map->uniforms()},
                                     {glsl::kBindMapDepth, visibility.map->depth()}});
    commands.dispatch(program("vsv/march_map.comp.glsl",
                              {{.id = 0, .value = visibility.map->kind()}, {.id = 4, .value = instanced}}),
                      groupCount_, gpu::asPush(push), bindings);
  } else {
    GNOMON_CHECK(visibility.volume != nullptr);
    bindings.insert(bindings.end(), {{glsl::kBindMap, visibility.volume->uniforms()},
                                     {glsl::kBindBits, visibility.volume->bits()},
                                     {glsl::kBindRunning, running_}});
    commands.dispatch(
        program("vsv/integrate_bits.comp.glsl",
                {{.id = 0, .value = bitsIntegrator(method.integrator)}, {.id = 4, .value = instanced}}),
        groupCount_, gpu::asPush(push), bindings);
  }
  commands.endStage();
}

void MediaPass::recordSurfaces(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                               const gpu::Buffer& shade, const gpu::Buffer& visibility, bool add) {
  commands.beginStage("media surfaces");
  commands.dispatch(program("vsv/shade_surface_in_medium.comp.glsl", {}), groupCount_,
                    gpu::asPush(glsl::MediaPush{.add = add ? 1 : 0}),
                    {{glsl::kBindPositions, scene.positions},
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
                     {glsl::kBindSurface, surfaces_}});
  commands.endStage();
}

void MediaPass::recordSum(gpu::Commands& commands) {
  commands.dispatch(program("vsv/add_scattered_light.comp.glsl", {}), groupCount_, {},
                    {{glsl::kBindMedia, uniforms_},
                     {glsl::kBindInScattered, inScattered_},
                     {glsl::kBindSurface, surfaces_},
                     {glsl::kBindMediaRadiance, radiance_}});
}

}  // namespace gnomon
