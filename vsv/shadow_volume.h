#pragma once
// A voxelized shadow volume on the GPU: the light's visibility in a whole view volume, one bit a voxel, in epipolar
// coordinates (shaders/shared/epipolar.glsl). Wyman 2011.

#include "shadow/map_image.h"

#include "shared/epipolar.glsl"

namespace gnomon {

struct VolumeSize {
  int alpha = 1024, theta = 1024, phi = 512;  // voxels; phi a multiple of 128
};
// "AxTxP". Throws UsageError.
VolumeSize parseVolumeSize(const std::string& text);

// Where occluders come from.
enum class VolumeSource {
  Resample,  // a cube map of the scene, looked up along each column (the papers' way)
  Direct,    // the scene itself, drawn into (theta, phi), each column deciding by its own ray
};
VolumeSource parseVolumeSource(const std::string& name);  // resample, direct. Throws UsageError.
const char* volumeSourceName(VolumeSource source);

// What alpha, theta and phi cover.
enum class VolumeFit {
  Frustum,  // what the camera sees, from the eye to the surfaces
  Full,     // the whole sphere, as in the papers
};
VolumeFit parseVolumeFit(const std::string& name);  // frustum, full. Throws UsageError.
const char* volumeFitName(VolumeFit fit);

// A column's grid and the map of its occluders: a FittedMap of kind kMapEpipolar whose texels are the columns
// (theta along u, phi along v) and whose depth grows with alpha.
struct FittedVolume {
  glsl::EpipolarGrid grid{};
  FittedMap columns;
};
FittedVolume fitVolume(const FitInput& input, const VolumeSize& size, VolumeFit fit);

class ShadowVolume {
 public:
  // Throws WorldError that says what size would fit, where the device cannot hold it.
  ShadowVolume(const gpu::Device& device, const FittedVolume& fitted);

  const FittedVolume& fitted() const { return fitted_; }
  const gpu::Buffer& bits() const { return bits_; }          // 128 phi bits a uvec4; epipolarTexelIndex says where
  const gpu::Buffer& occluders() const { return occluders_; }  // float alpha a column, theta fastest; infinity where none

 private:
  FittedVolume fitted_;
  gpu::Buffer bits_, occluders_;
};

// The volume in host memory, for the CPU to check: bit(i, j, k) is 1 where the voxel is occluded.
class VolumeBits {
 public:
  VolumeBits(const glsl::EpipolarGrid& grid, std::vector<glm::uvec4> texels)
      : grid_(grid), texels_(std::move(texels)) {}
  bool bit(int alpha, int theta, int phi) const;
  const glsl::EpipolarGrid& grid() const { return grid_; }

 private:
  glsl::EpipolarGrid grid_;
  std::vector<glm::uvec4> texels_;
};
VolumeBits downloadBits(const gpu::Device& device, const ShadowVolume& volume);

}  // namespace gnomon
