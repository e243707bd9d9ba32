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

const char* layoutOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R32_SFLOAT:
      return "r32f";
    case VK_FORMAT_R16_SFLOAT:
      return "r16f";
    case VK_FORMAT_R8_UNORM:
      return "r8";
    default:
      throw WorldError(fmt::format("visibility in an image of VkFormat {}: make it R32_SFLOAT, R16_SFLOAT or R8_UNORM",
                                   static_cast<int>(format)));
  }
}

gpu::ShaderSource storingAs(gpu::ShaderSource source, VkFormat format) {
  if (format != VK_FORMAT_UNDEFINED)
    source.overrides["shadow/store_visibility.glsl"] = fmt::format(
        "#include \"shared/shade.glsl\"\n"
        "layout(binding = kBindVisibility, {}) uniform writeonly image2D visibilityImage;\n"
        "void storeVisibility(ivec2 pixel, int width, float value) {{\n"
        "  imageStore(visibilityImage, pixel, vec4(value));\n"
        "}}\n",
        layoutOf(format));
  return source;
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

std::vector<gpu::Binding> lookupBindings(const SceneBuffers& scene, const ReceiverPicture& receivers,
                                         const gpu::Buffer& meaning, const MapImage& map, const gpu::Image& noIds) {
  std::vector<gpu::Binding> bindings = {{glsl::kBindPositions, scene.positions},
                                        {glsl::kBindTriangles, scene.triangles},
                                        {glsl::kBindInstances, scene.instances},
                                        {glsl::kBindMap, map.uniforms()}};
  receivers.bind(bindings, meaning);
  for (const Channel& channel : channels()) {
    const bool lacksIds = channel.format == VK_FORMAT_R32_UINT && (map.channels() & channel.bit) == 0;
    bindings.emplace_back(channel.binding, lacksIds ? noIds : map.imageOrAny(channel.bit));
  }
  return bindings;
}

gpu::Image createNoIds(const gpu::Device& device) {
  return {device, {.name = "no ids", .format = VK_FORMAT_R32_UINT, .array = true, .usage = VK_IMAGE_USAGE_SAMPLED_BIT}};
}

gpu::ComputeProgram createLookupProgram(const gpu::Device& device, const gpu::ShaderSource& shader,
                                        const UserBias* user, const std::vector<gpu::Specialization>& constants) {
  try {
    return {device, shader, constants};
  } catch (const WorldError& error) {
    if (user == nullptr) throw;
    throw WorldError(inUsersWords(error.what(), *user));
  }
}

VisibilityPass::VisibilityPass(const gpu::Device& device, int width, int height, Output output)
    : device_(device),
      groupCount_(shadeGroups(width, height)),
      uniforms_(
          device,
          {.name = "shade uniforms", .size = sizeof(glsl::ShadeUniforms), .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}),
      receiverPicture_(device, {.name = "receiver picture",
                                .size = sizeof(glsl::ReceiverPicture),
                                .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT}),
      visibility_(device, {.name = "visibility",
                           .size = output == Output::Buffers ? pixelBytes(width, height, sizeof(float)) : 0}),
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

void VisibilityPass::recordUniforms(gpu::Commands& commands, const glsl::ShadeUniforms& uniforms,
                                    const glsl::ReceiverPicture& meaning) {
  commands.update(uniforms_, gpu::asPush(uniforms));
  commands.update(receiverPicture_, gpu::asPush(meaning));
  commands.barrier("the frame's numbers are written -> look-ups read them");
  witnessReach_ = uniforms.bias.witnessReach;
}

gpu::ShaderSource VisibilityPass::storingIn(gpu::ShaderSource source, const gpu::Image* image) {
  return storingAs(std::move(source), image != nullptr ? image->desc().format : VK_FORMAT_UNDEFINED);
}

gpu::Binding VisibilityPass::storage(const gpu::Image* image) const {
  if (image != nullptr) return {glsl::kBindVisibility, *image};
  return {glsl::kBindVisibility, visibility_};
}

gpu::ComputeProgram VisibilityPass::makeProgram(const VariantKey& key) const {
  return createLookupProgram(
      device_,
      storingAs(ReceiverPicture::shader(shaderWith(kVisibilityShader, key.user.bias), key.receivers), key.stored),
      key.user.bias,
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
       {.id = 11, .value = key.witnessReach},
       ReceiverPicture::constant(key.receivers)});
}

bool VisibilityPass::inStages(const ShadowLookup& lookup) {
  return !lookup.once && lookup.bias.id == glsl::kBiasWitness && lookup.filter.id == glsl::kShadowFilterNone;
}

const gpu::ComputeProgram& VisibilityPass::programOf(const SceneBuffers& scene, ReceiverKind receivers,
                                                     const MapImage& map, const ShadowLookup& lookup, int stage) {
  const BiasMethod& method = lookup.bias;
  const int reach = method.id == glsl::kBiasWitness ? witnessReach_ : 2;
  return variants_.get(
      {method.id, lookup.diagnose ? 1 : 0, map.kind(), map.sliceCount(), scene.instanced ? 1 : 0, method.channels,
       lookup.filter.id, lookup.filter.tapCount, scene.masked ? 1 : 0, stage, reach, method.user, receivers,
       lookup.into != nullptr ? lookup.into->desc().format : VK_FORMAT_UNDEFINED},
      [&](const VariantKey& key) { return makeProgram(key); });
}

void VisibilityPass::prepare(const SceneBuffers& scene, ReceiverKind receivers, const MapImage& map,
                             const ShadowLookup& lookup) {
  if (!inStages(lookup)) {
    programOf(scene, receivers, map, lookup, glsl::kStageWhole);
    return;
  }
  for (const int stage : {glsl::kStageLists, glsl::kStageWalks, glsl::kStageWalksAcross})
    programOf(scene, receivers, map, lookup, stage);
}

void VisibilityPass::record(gpu::Commands& commands, const SceneBuffers& scene, const ReceiverPicture& receivers,
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
  std::vector<gpu::Binding> bindings = lookupBindings(scene, receivers, receiverPicture_, map, noIds_);
  bindings.insert(bindings.end(), {{glsl::kBindMeshRows, scene.meshRows},
                                   {glsl::kBindIdChunks, scene.idChunks},
                                   {glsl::kBindTriangleFacts, scene.triangleFacts},
                                   {glsl::kBindUvs, scene.uvs},
                                   {glsl::kBindMaterials, scene.materials},
                                   {glsl::kBindTextures, scene.textures},
                                   {glsl::kBindTexels, scene.texels},
                                   {glsl::kBindShade, uniforms_},
                                   storage(lookup.into),
                                   {glsl::kBindDiagnosis, diagnosisFor(lookup)},
                                   {glsl::kBindWalkers, walkers_},
                                   {glsl::kBindWalkDispatch, walkDispatches_}});
  // Of receivers that are not of Gnomon's own a shader does not read all.
  const auto dispatch = [&](int stage, VkDeviceSize walks) {
    const gpu::ComputeProgram& found = programOf(scene, receivers.kind(), map, lookup, stage);
    const bool all = receivers.kind() == ReceiverKind::GBuffer;
    const std::vector<gpu::Binding> read = all ? bindings : gpu::declaredBy(found, bindings);
    if (stage == glsl::kStageWhole || stage == glsl::kStageLists)
      commands.dispatch(found, groupsOf(lookup), gpu::asPush(push), read);
    else
      commands.dispatchIndirect(found, walkDispatches_, walks, gpu::asPush(push), read);
  };
  if (!inStages(lookup)) {
    dispatch(glsl::kStageWhole, 0);
    return;
  }
  commands.fill(walkDispatches_, 1);
  commands.barrier("the list of walks is empty -> pixels are listed");
  dispatch(glsl::kStageLists, 0);
  commands.barrier("pixels are listed -> they walk");
  dispatch(glsl::kStageWalks, 0);
  dispatch(glsl::kStageWalksAcross, sizeof(glsl::WalkDispatch));
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
