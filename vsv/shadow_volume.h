#pragma once
// A voxelized shadow volume on the GPU: the light's visibility in a whole view volume, one bit a voxel, in
// epipolar coordinates (shaders/shared/epipolar.glsl). Wyman 2011.
//
// VolumeRenderer (volume_renderer.h) fills it: the nearest occluder of each column, then the bits.

#include "shadow/map_image.h"

#include "shared/epipolar.glsl"

#include <memory>
#include <string>

namespace gnomon {

// Voxels along the three angles; phi a multiple of 128.
struct VolumeSize {
  int alpha = 1024, theta = 1024, phi = 512;
  bool operator==(const VolumeSize&) const = default;
};
std::string volumeSizeName(const VolumeSize& size);  // "1024x1024x512"
// Half of each side, as far as that is a size.
VolumeSize halvedSize(const VolumeSize& size);

// What alpha, theta and phi cover.
enum class VolumeFit {
  Frustum,  // what the camera sees, from the eye to the surfaces
  Full,     // the whole sphere, as in the papers
};

// A column's grid and the map of its occluders: a FittedMap of kind kMapEpipolar whose texels are the columns
// (theta along u, phi along v) and whose depth grows with alpha.
struct FittedVolume {
  glsl::EpipolarGrid grid{};
  FittedMap columns;
};
// `input.side` counts for nothing. Throws WorldError where the light stands at the camera's eye: there is no
// axis.
FittedVolume fitVolume(const FitInput& input, const VolumeSize& size, VolumeFit fit);

class ShadowVolume {
 public:
  // `source`: the map whose look-up along each column gives its occluder; none: the columns' own map is
  // drawn. Throws WorldError that says what size would fit, where the device cannot hold it.
  ShadowVolume(const gpu::Device& device, const FittedVolume& fitted,
               const std::shared_ptr<const FittedMap>& source = nullptr);

  const FittedVolume& fitted() const { return fitted_; }
  const gpu::Buffer& bits() const { return bits_; }  // 128 phi bits a uvec4; epipolarTexelIndex says where
  const gpu::Buffer& occluders() const {
    return occluders_;
  }                                                          // float alpha a column, theta fastest; infinity where none
  const gpu::Buffer& uniforms() const { return uniforms_; }  // glsl::MapUniforms of the columns
  const MapImage& source() const { return source_; }         // the columns' own map, or the one they are looked up in
  MapImage& source() { return source_; }

 private:
  FittedVolume fitted_;
  gpu::Buffer uniforms_, bits_, occluders_;
  MapImage source_;
};

// The volume in host memory, for the CPU to check: bit(i, j, k) is 1 where the voxel is occluded.
class VolumeBits {
 public:
  VolumeBits(const glsl::EpipolarGrid& grid, std::vector<glm::uvec4> texels)
      : grid_(grid), texels_(std::move(texels)) {}
  bool bit(int alpha, int theta, int phi) const;
  const glsl::EpipolarGrid& grid() const { return grid_; }
  const std::vector<glm::uvec4>& texels() const { return texels_; }

 private:
  glsl::EpipolarGrid grid_;
  std::vector<glm::uvec4> texels_;
};
VolumeBits downloadBits(const gpu::Device& device, const ShadowVolume& volume);

// Of the whole buffer: thetas are rounded up to kThetaBlock.
uint64_t volumeTexelCount(const glsl::EpipolarGrid& grid);

}  // namespace gnomon
