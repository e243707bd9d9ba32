#include "vsv/volume_parameterization.h"

#include "base/check.h"
#include "omni/cube_map.h"
#include "vsv/shadow_volume.h"

namespace gnomon {

namespace {

class VolumeParameterization final : public Parameterization {
 public:
  const char* name() const override { return "vsv"; }
  const char* sentence() const override { return "a voxelized shadow volume in epipolar coordinates"; }
  int layerCount(const MapOptions&) const override { return 1; }

  LightSupport supportsLight(LightType type) const override {
    return type == LightType::Directional ? LightSupport::No : LightSupport::Yes;
  }

  LightModel lightModel(const Light& light, const glm::dvec3&) const override {
    return {.type = LightType::Point, .positionW = glm::dvec3(light.positionW)};
  }

  bool supportsBias(const BiasMethod& method) const override { return volumeSupportsBias(method); }
  bool supportsFilters() const override { return false; }

  FittedMap fit(const FitInput& input) const override {
    const MapOptions& options = input.options;
    FittedMap columns = fitVolume(input, options.volumeSize, options.volumeFit);
    if (options.volumeSource == VolumeSource::Resample) {
      FitInput cube = input;
      // All of the scene casts into the whole sphere, and not only what stands before the camera's surfaces.
      if (options.volumeFit == VolumeFit::Full) cube.receiversW = {};
      columns.occluderSource = std::make_shared<const FittedMap>(cubeParameterization().fit(cube));
    }
    return columns;
  }

  std::unique_ptr<Occluders> createOccluders(const gpu::Device& device, const FittedMap& fitted,
                                             MapContent content) const override {
    GNOMON_CHECK(content == MapContent::OneLayer);
    return std::make_unique<ShadowVolume>(device, fitted);
  }
};

}  // namespace

const Parameterization& volumeParameterization() {
  static const VolumeParameterization volume;
  return volume;
}

}  // namespace gnomon
