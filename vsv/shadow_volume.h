#pragma once
// A voxelized shadow volume on the GPU: the light's visibility in the whole view frustum, one bit a voxel, in epipolar
// coordinates (shaders/shared/epipolar.glsl). Wyman 2011.
//
// It is filled in three steps: the source map, the nearest occluder of each column, the bits.

#include "shadow/map_image.h"

#include "shared/epipolar.glsl"

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
  View,     // what the camera sees, however far: for who does not know the surfaces
  Full,     // the whole sphere, as in the papers
};

// The grid of columns: a FittedMap of kind kMapEpipolar whose texels are the columns (theta along u, phi along v) and
// whose depth grows with alpha. `input.side` counts for nothing. Throws WorldError where the light stands at the
// camera's eye: there is no axis.
FittedMap fitVolume(const FitInput& input, const VolumeSize& size, VolumeFit fit);

// The same without a scene on the CPU; VolumeFit::Frustum is View.
FittedMap makeVolume(const glm::dvec3& lightW, const glsl::CameraView& camera, const Bounds& sceneBoundsW,
                     const VolumeSize& size, VolumeFit fit);

// How the bits are made of the occluders. Both give the same bits.
enum class Voxelization {
  // One pass: an invocation takes 128 columns, clears their texels as far as a bit is set, sets the first
  // occluded voxel of each, and ORs along alpha.
  Fused,
  // The papers' way: the whole volume is cleared, then the first voxels are set, then all is scanned.
  Passes,
};

class ShadowVolume final : public Occluders {
 public:
  // Occluders come from columns.occluderSource, looked up along each column, or where there is none from the columns'
  // own map. Throws WorldError that says what size would fit, where the device cannot hold it.
  ShadowVolume(const gpu::Device& device, const FittedMap& columns);

  // Stages "volume source", "volume occluders", "volume bits".
  void recordDrawing(gpu::Commands& commands, const MapRenderer& renderer, const SceneBuffers& scene,
                     const LightModel& light, CullMode cull) override;
  // Compiles and makes all that takes.
  void prepare(const MapRenderer& renderer, const SceneBuffers& scene);
  void recordFit(gpu::Commands& commands, const FittedMap& columns) override;
  // The bits alone, from what occluders() holds. `programs`: a MapRenderer's.
  void recordBits(gpu::Commands& commands, const gpu::ComputePrograms& programs, Voxelization how) const;
  // Unfiltered only.
  void recordVisibility(gpu::Commands& commands, const SceneBuffers& scene, const ReceiverPicture& receivers,
                        VisibilityPass& pass, const ShadowLookup& lookup) const override;
  // What that takes, compiled if it is not yet.
  static const gpu::ComputeProgram& visibilityProgram(const SceneBuffers& scene, ReceiverKind receivers,
                                                      const VisibilityPass& pass, const ShadowLookup& lookup);

  const glsl::EpipolarGrid& grid() const { return fitted().map.epipolar; }
  const gpu::Buffer* bits() const override { return &bits_; }  // 128 phi bits a uvec4; epipolarTexelIndex says where
  const gpu::Image& depth() const override { return source_.depth(); }
  std::vector<float> downloadDepth(const gpu::Device& device) const override;

  // float alpha a column, theta fastest; infinity where none
  const gpu::Buffer& occluders() const { return occluders_; }
  const MapImage& source() const { return source_; }  // the columns' own map, or the one they are looked up in

 private:
  gpu::Buffer bits_, occluders_;
  MapImage source_;
};

// Occluders that are known to be a volume, as volumeParameterization() creates them.
const ShadowVolume& asVolume(const Occluders& occluders);

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
