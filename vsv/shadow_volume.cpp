#include "vsv/shadow_volume.h"

#include "base/check.h"
#include "base/error.h"
#include "shadow/visibility_pass.h"

#include "shared/volume.glsl"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

uint64_t bytesOf(const glsl::EpipolarGrid& grid) {
  return volumeTexelCount(grid) * sizeof(glm::uvec4);
}

// The longest side is halved until the bits fit.
VolumeSize sizeThatFits(glsl::EpipolarGrid grid, uint64_t most) {
  while (bytesOf(grid) > most) {
    int* const longest = std::max({&grid.alphaCount, &grid.thetaCount, &grid.phiCount},
                                  [](const int* a, const int* b) { return *a < *b; });
    *longest /= 2;
    if (longest == &grid.phiCount) grid.phiCount = std::max(grid.phiCount / glsl::kPhiBits, 1) * glsl::kPhiBits;
  }
  return {.alpha = grid.alphaCount, .theta = grid.thetaCount, .phi = grid.phiCount};
}

const FittedMap& checkedFor(const gpu::Device& device, const FittedMap& columns) {
  const glsl::EpipolarGrid& grid = columns.map.epipolar;
  const uint64_t most = std::min(device.info().maxStorageBufferBytes, device.info().maxAllocationBytes);
  if (bytesOf(grid) > most)
    throw WorldError(
        fmt::format("--vsv-size {}: needs {} MiB, more than the device's largest buffer, {} MiB; {} would fit",
                    volumeSizeName({.alpha = grid.alphaCount, .theta = grid.thetaCount, .phi = grid.phiCount}),
                    bytesOf(grid) >> 20, most >> 20, volumeSizeName(sizeThatFits(grid, most))));
  return columns;
}

uint32_t groups(int count, int size) {
  return static_cast<uint32_t>((count + size - 1) / size);
}

}  // namespace

std::string volumeSizeName(const VolumeSize& size) {
  return fmt::format("{}x{}x{}", size.alpha, size.theta, size.phi);
}

VolumeSize halvedSize(const VolumeSize& size) {
  return {.alpha = std::max(size.alpha / 2, 2),
          .theta = std::max(size.theta / 2, 2),
          .phi = std::max(size.phi / 256 * 128, 128)};
}

uint64_t volumeTexelCount(const glsl::EpipolarGrid& grid) {
  const uint64_t thetas =
      static_cast<uint64_t>((grid.thetaCount + glsl::kThetaBlock - 1) / glsl::kThetaBlock) * glsl::kThetaBlock;
  return thetas * static_cast<uint64_t>(grid.alphaCount) * static_cast<uint64_t>(grid.phiCount / glsl::kPhiBits);
}

ShadowVolume::ShadowVolume(const gpu::Device& device, const FittedMap& columns)
    : Occluders(device, checkedFor(device, columns), "volume uniforms"),
      bits_(device, {.name = "volume bits", .size = bytesOf(grid())}),
      occluders_(device, {.name = "volume occluders",
                          .size = static_cast<VkDeviceSize>(grid().thetaCount) *
                                  static_cast<VkDeviceSize>(grid().phiCount) * sizeof(float)}),
      source_(device, columns.occluderSource ? *columns.occluderSource : columns) {}

void ShadowVolume::prepare(const MapRenderer& renderer, const SceneBuffers& scene) {
  renderer.prepare(scene, source_);
  renderer.programs().get("vsv/find_occluders.comp.glsl", {{.id = 0, .value = source_.kind()}});
  renderer.programs().get("vsv/voxelize.comp.glsl", {{.id = 0, .value = glsl::kVoxelizeFused}});
}

void ShadowVolume::recordFit(gpu::Commands& commands, const FittedMap& columns) {
  Occluders::recordFit(commands, columns);
  source_.recordFit(commands, columns.occluderSource ? *columns.occluderSource : columns);
}

void ShadowVolume::recordDrawing(gpu::Commands& commands, const MapRenderer& renderer, const SceneBuffers& scene,
                                 const LightModel& light, CullMode cull) {
  commands.beginStage("volume source");
  renderer.record(commands, scene, source_, light, cull);
  commands.endStage();
  commands.barrier("the source's depth is written -> columns read it");

  commands.beginStage("volume occluders");
  commands.dispatch(
      renderer.programs().get("vsv/find_occluders.comp.glsl", {{.id = 0, .value = source_.kind()}}),
      {groups(grid().thetaCount, glsl::kColumnGroupSide), groups(grid().phiCount, glsl::kColumnGroupSide), 1}, {},
      {{glsl::kBindMap, uniforms()},
       {glsl::kBindSourceMap, source_.uniforms()},
       {glsl::kBindMapDepth, source_.depth()},
       {glsl::kBindOccluders, occluders_}});
  commands.endStage();
  commands.barrier("occluders are written -> bits are set behind them");

  commands.beginStage("volume bits");
  recordBits(commands, renderer.programs(), Voxelization::Fused);
  commands.endStage();
  commands.barrier("bits are written -> visibility reads them");
}

void ShadowVolume::recordBits(gpu::Commands& commands, const gpu::ComputePrograms& programs, Voxelization how) const {
  const glm::uvec3 size(groups(grid().thetaCount, glsl::kVoxelGroupSize),
                        static_cast<uint32_t>(grid().phiCount / glsl::kPhiBits), 1);
  const std::vector<gpu::Binding> bindings = {
      {glsl::kBindMap, uniforms()}, {glsl::kBindOccluders, occluders_}, {glsl::kBindBits, bits_}};
  const auto voxelize = [&](int32_t step) {
    commands.dispatch(programs.get("vsv/voxelize.comp.glsl", {{.id = 0, .value = step}}), size, {}, bindings);
  };
  if (how == Voxelization::Fused) {
    voxelize(glsl::kVoxelizeFused);
    return;
  }
  commands.fill(bits_, 0);
  commands.barrier("the volume is cleared -> the first occluded voxels are set");
  voxelize(glsl::kVoxelizeSeed);
  commands.barrier("the first occluded voxels are set -> the scan ORs what lies before");
  voxelize(glsl::kVoxelizeScan);
}

void ShadowVolume::recordVisibility(gpu::Commands& commands, const SceneBuffers& scene,
                                    const ReceiverPicture& receivers, VisibilityPass& pass,
                                    const ShadowLookup& lookup) const {
  GNOMON_CHECK(lookup.bias.onVolumes);
  GNOMON_CHECK_EQ(lookup.filter.id, glsl::kShadowFilterNone);
  const gpu::ComputeProgram& program = visibilityProgram(scene, receivers.kind(), pass, lookup);
  std::vector<gpu::Binding> bindings = {{glsl::kBindPositions, scene.positions},
                                        {glsl::kBindTriangles, scene.triangles},
                                        {glsl::kBindInstances, scene.instances},
                                        {glsl::kBindMap, uniforms()},
                                        {glsl::kBindBits, bits_},
                                        {glsl::kBindShade, pass.uniforms()},
                                        pass.storage(lookup.into),
                                        {glsl::kBindDiagnosis, pass.diagnosisFor(lookup)}};
  receivers.bind(bindings, pass.receiverPicture());
  const bool all = receivers.kind() == ReceiverKind::GBuffer;
  commands.dispatch(program, pass.groupsOf(lookup), {}, all ? bindings : gpu::declaredBy(program, bindings));
}

const gpu::ComputeProgram& ShadowVolume::visibilityProgram(const SceneBuffers& scene, ReceiverKind receivers,
                                                           const VisibilityPass& pass, const ShadowLookup& lookup) {
  const gpu::ShaderSource source = VisibilityPass::storingIn(
      ReceiverPicture::shader({"vsv/shade_volume_visibility.comp.glsl", {}}, receivers), lookup.into);
  return pass.programs().get(source, {{.id = 0, .value = lookup.bias.id},
                                      {.id = 1, .value = lookup.diagnose ? 1 : 0},
                                      {.id = 4, .value = scene.instanced ? 1 : 0},
                                      ReceiverPicture::constant(receivers)});
}

std::vector<float> ShadowVolume::downloadDepth(const gpu::Device& device) const {
  std::vector<float> depths = gpu::downloadAs<float>(device, occluders_);
  for (float& alpha : depths) alpha = std::min(alpha / glsl::alphaUpper(grid()), 1.0f);
  return depths;
}

const ShadowVolume& asVolume(const Occluders& occluders) {
  const auto* volume = dynamic_cast<const ShadowVolume*>(&occluders);
  GNOMON_CHECK(volume != nullptr);
  return *volume;
}

bool VolumeBits::bit(int alpha, int theta, int phi) const {
  const glm::uvec4& texel = texels_[glsl::epipolarTexelIndex(grid_, alpha, theta, phi / glsl::kPhiBits)];
  return (texel[phi % glsl::kPhiBits / 32] >> (phi % 32) & 1u) != 0;
}

VolumeBits downloadBits(const gpu::Device& device, const ShadowVolume& volume) {
  return {volume.grid(), gpu::downloadAs<glm::uvec4>(device, *volume.bits())};
}

}  // namespace gnomon
