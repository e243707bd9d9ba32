#include "shadow/visibility_pass.h"

#include "base/check.h"
#include "base/error.h"
#include "shadow/user_bias.h"

#include "shared/lookup_tables.glsl"

#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

// As shade_visibility.comp.glsl declares it.
struct VisibilityPush {
  glsl::FilterParams filter;
  float endMargin;
  uint32_t idShift;
};

VkDeviceSize pixelBytes(int width, int height, size_t each) {
  return static_cast<VkDeviceSize>(width) * static_cast<VkDeviceSize>(height) * each;
}

}  // namespace

glsl::ShadeUniforms shadeUniforms(const glsl::CameraView& camera, const LightModel& light,
                                  const glsl::BiasParams& bias) {
  const bool positional = light.type != LightType::Directional;
  glsl::ShadeUniforms shade{};
  shade.camera = camera;
  shade.bias = bias;
  shade.lightW = positional ? glm::vec3(light.positionW) : -glm::vec3(light.directionW);
  shade.positional = positional ? 1.0f : 0.0f;
  shade.coneAxisW = glm::vec3(light.directionW);
  shade.coneCos = light.type == LightType::Spot ? static_cast<float>(std::cos(light.outerConeRad)) : -1.0f;
  shade.lightColor = glm::vec3(1.0f);
  shade.ambient = glm::vec3(0.0f);
  return shade;
}

glm::uvec3 shadeGroups(int width, int height) {
  const uint32_t side = glsl::kShadeGroupSide;
  return {(static_cast<uint32_t>(width) + side - 1) / side, (static_cast<uint32_t>(height) + side - 1) / side, 1};
}

std::vector<gpu::Binding> lookupBindings(const SceneBuffers& scene, const GBuffer& gbuffer, const MapImage& map,
                                         const gpu::Image& noIds) {
  std::vector<gpu::Binding> bindings = {
      {glsl::kBindPositions, scene.positions},           {glsl::kBindTriangles, scene.triangles},
      {glsl::kBindInstances, scene.instances},           {glsl::kBindMap, map.uniforms()},
      {glsl::kBindPrimitiveIds, gbuffer.primitiveIds()},
  };
  for (const Channel& channel : channels()) {
    const bool lacksIds = channel.format == VK_FORMAT_R32_UINT && (map.channels() & channel.bit) == 0;
    bindings.emplace_back(channel.binding, lacksIds ? noIds : map.imageOrAny(channel.bit));
  }
  return bindings;
}

gpu::Image createNoIds(const gpu::Device& device) {
  return {device, {.name = "no ids", .format = VK_FORMAT_R32_UINT, .array = true, .usage = VK_IMAGE_USAGE_SAMPLED_BIT}};
}

gpu::ComputeProgram createLookupProgram(const gpu::Device& device, const char* shader, const UserBias* user,
                                        const std::vector<gpu::Specialization>& constants) {
  try {
    return {device, shaderWith(shader, user), constants};
  } catch (const WorldError& error) {
    if (user == nullptr) throw;
    throw WorldError(inUsersWords(error.what(), *user));
  }
}

VisibilityPass::VisibilityPass(const gpu::Device& device, int width, int height)
    : device_(device),
      groupCount_(shadeGroups(width, height)),
      uniforms_(
          device,
          {.name = "shade uniforms", .size = sizeof(glsl::ShadeUniforms), .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}),
      visibility_(device, {.name = "visibility", .size = pixelBytes(width, height, sizeof(float))}),
      diagnosis_(device, {.name = "no diagnosis", .size = sizeof(glsl::PixelDiagnosis)}),
      walkers_(device, {.name = "walkers", .size = pixelBytes(width, height, sizeof(uint32_t))}),
      walkDispatches_(device, {.name = "walk dispatches",
                               .size = 2 * sizeof(glsl::WalkDispatch),
                               .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT}),
      noIds_(createNoIds(device)),
      programs_(device) {}

const gpu::Buffer& VisibilityPass::diagnosisFor(const ShadowLookup& lookup) {
  const VkDeviceSize bytes = visibility_.size() / sizeof(float) * sizeof(glsl::PixelDiagnosis);
  if (lookup.diagnose && diagnosis_.size() < bytes)
    diagnosis_ = gpu::Buffer(device_, {.name = "diagnosis", .size = bytes});
  return diagnosis_;
}

void VisibilityPass::setUniforms(const glsl::ShadeUniforms& uniforms) {
  gpu::upload(device_, uniforms_, gpu::asPush(uniforms));
  witnessReach_ = uniforms.bias.witnessReach;
}

const gpu::ComputeProgram& VisibilityPass::program(const VariantKey& key) {
  for (const auto& variant : variants_)
    if (variant->key == key) return variant->program;
  gpu::ComputeProgram made = createLookupProgram(device_, kVisibilityShader, key.user,
                                                 {{.id = 0, .value = key.method},
                                                  {.id = 1, .value = key.diagnose},
                                                  {.id = 2, .value = key.mapKind},
                                                  {.id = 3, .value = key.sliceCount},
                                                  {.id = 4, .value = key.instanced},
                                                  {.id = 5, .value = key.channels},
                                                  {.id = 6, .value = key.filter},
                                                  {.id = 7, .value = key.tapCount},
                                                  {.id = 9, .value = key.masked},
                                                  {.id = 10, .value = key.stage},
                                                  {.id = 11, .value = key.witnessReach}});
  variants_.push_back(std::make_unique<Variant>(Variant{key, std::move(made)}));
  return variants_.back()->program;
}

void VisibilityPass::record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                            const MapImage& map, const ShadowLookup& lookup) {
  const BiasMethod& method = lookup.bias;
  const ChosenFilter& filter = lookup.filter;
  const bool diagnose = lookup.diagnose;
  GNOMON_CHECK(!diagnose || filter.id == glsl::kShadowFilterNone);
  GNOMON_CHECK_EQ(method.channels & ~map.channels(), 0);
  if (method.knowsSurfaces() &&
      scene.meshRows.size() < scene.triangles.size() / sizeof(uint32_t) * sizeof(glsl::MeshRow))
    throw WorldError(fmt::format(
        "--biases {}: the device's texel buffers hold {} rows, and the scene has {}, three a triangle; choose "
        "another bias",
        method.name, device_.info().maxTexelBufferElements, scene.triangles.size() / sizeof(uint32_t)));
  const VisibilityPush push{.filter = filter.params, .endMargin = scene.endMargin, .idShift = scene.ids.shift};
  std::vector<gpu::Binding> bindings = lookupBindings(scene, gbuffer, map, noIds_);
  bindings.insert(bindings.end(), {{glsl::kBindMeshRows, scene.meshRows},
                                   {glsl::kBindIdChunks, scene.idChunks},
                                   {glsl::kBindTriangleFacts, scene.triangleFacts},
                                   {glsl::kBindUvs, scene.uvs},
                                   {glsl::kBindMaterials, scene.materials},
                                   {glsl::kBindTextures, scene.textures},
                                   {glsl::kBindTexels, scene.texels},
                                   {glsl::kBindShade, uniforms_},
                                   {glsl::kBindVisibility, visibility_},
                                   {glsl::kBindDiagnosis, diagnosisFor(lookup)},
                                   {glsl::kBindWalkers, walkers_},
                                   {glsl::kBindWalkDispatch, walkDispatches_}});
  const int reach = method.id == glsl::kBiasWitness ? witnessReach_ : 2;
  const auto programOf = [&](int stage) -> const gpu::ComputeProgram& {
    return program({method.id, diagnose ? 1 : 0, map.kind(), map.sliceCount(), scene.instanced ? 1 : 0, method.channels,
                    filter.id, filter.tapCount, scene.masked ? 1 : 0, stage, reach, method.user});
  };
  const glm::uvec3 groups = groupsOf(lookup);
  if (lookup.once || method.id != glsl::kBiasWitness || filter.id != glsl::kShadowFilterNone) {
    commands.dispatch(programOf(glsl::kStageWhole), groups, gpu::asPush(push), bindings);
    return;
  }
  commands.fill(walkDispatches_, 1);
  commands.barrier("the list of walks is empty -> pixels are listed");
  commands.dispatch(programOf(glsl::kStageLists), groups, gpu::asPush(push), bindings);
  commands.barrier("pixels are listed -> they walk");
  commands.dispatchIndirect(programOf(glsl::kStageWalks), walkDispatches_, 0, gpu::asPush(push), bindings);
  commands.dispatchIndirect(programOf(glsl::kStageWalksAcross), walkDispatches_, sizeof(glsl::WalkDispatch),
                            gpu::asPush(push), bindings);
}

RadiancePass::RadiancePass(const gpu::Device& device, int width, int height)
    : device_(device),
      programs_(device),
      pixelCount_(static_cast<size_t>(width) * static_cast<size_t>(height)),
      groupCount_(shadeGroups(width, height)) {}

void RadiancePass::record(gpu::Commands& commands, const SceneBuffers& scene, const GBuffer& gbuffer,
                          const gpu::Buffer& shadeUniforms, const gpu::Buffer& visibility) {
  if (radiance_.handle() == VK_NULL_HANDLE)
    radiance_ = gpu::Buffer(device_, {.name = "radiance", .size = pixelCount_ * sizeof(glm::vec3)});
  commands.dispatch(programs_.get("shadow/shade_radiance.comp.glsl", {{.id = 4, .value = scene.instanced ? 1 : 0},
                                                                      {.id = 8, .value = scene.textured ? 1 : 0}}),
                    groupCount_, {},
                    {{glsl::kBindPositions, scene.positions},
                     {glsl::kBindTriangles, scene.triangles},
                     {glsl::kBindInstances, scene.instances},
                     {glsl::kBindUvs, scene.uvs},
                     {glsl::kBindNormals, scene.normals},
                     {glsl::kBindMaterials, scene.materials},
                     {glsl::kBindTextures, scene.textures},
                     {glsl::kBindTexels, scene.texels},
                     {glsl::kBindPrimitiveIds, gbuffer.primitiveIds()},
                     {glsl::kBindShade, shadeUniforms},
                     {glsl::kBindVisibility, visibility},
                     {glsl::kBindRadiance, radiance_}});
}

}  // namespace gnomon
