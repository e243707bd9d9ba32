#include "vsv/shadow_volume.h"

#include "base/error.h"

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

const FittedVolume& checkedFor(const gpu::Device& device, const FittedVolume& fitted) {
  const glsl::EpipolarGrid& grid = fitted.grid;
  const uint64_t most = std::min(device.info().maxStorageBufferBytes, device.info().maxAllocationBytes);
  if (bytesOf(grid) > most)
    throw WorldError(
        fmt::format("--vsv-size {}: {} MiB of voxels are more than the device's largest buffer, {} MiB; {} would fit",
                    volumeSizeName({.alpha = grid.alphaCount, .theta = grid.thetaCount, .phi = grid.phiCount}),
                    bytesOf(grid) >> 20, most >> 20, volumeSizeName(sizeThatFits(grid, most))));
  return fitted;
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

ShadowVolume::ShadowVolume(const gpu::Device& device, const FittedVolume& fitted,
                           const std::shared_ptr<const FittedMap>& source)
    : fitted_(checkedFor(device, fitted)),
      uniforms_(gpu::createBufferWith(
          device, "volume uniforms",
          std::vector<glsl::MapUniforms>{{.lightFrame = fitted.columns.frame, .shadowMap = fitted.columns.map}},
          VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)),
      bits_(device, {.name = "volume bits", .size = bytesOf(fitted.grid)}),
      occluders_(device, {.name = "volume occluders",
                          .size = static_cast<VkDeviceSize>(fitted.grid.thetaCount) *
                                  static_cast<VkDeviceSize>(fitted.grid.phiCount) * sizeof(float)}),
      source_(device, source ? *source : fitted.columns) {}

bool VolumeBits::bit(int alpha, int theta, int phi) const {
  const glm::uvec4& texel = texels_[glsl::epipolarTexelIndex(grid_, alpha, theta, phi / glsl::kPhiBits)];
  return (texel[phi % glsl::kPhiBits / 32] >> (phi % 32) & 1u) != 0;
}

VolumeBits downloadBits(const gpu::Device& device, const ShadowVolume& volume) {
  return {volume.fitted().grid, gpu::downloadAs<glm::uvec4>(device, volume.bits())};
}

}  // namespace gnomon
