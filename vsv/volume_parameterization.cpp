#include "vsv/volume_parameterization.h"

#include "base/check.h"
#include "base/error.h"
#include "omni/cube_map.h"
#include "vsv/shadow_volume.h"

#include <charconv>

#include <fmt/format.h>

namespace gnomon {

namespace {

VolumeSize parseVolumeSize(const std::string& flag, const std::string& text) {
  int sides[3] = {0, 0, 0};
  const char* at = text.data();
  const char* const end = at + text.size();
  bool good = true;
  for (int i = 0; i < 3 && good; ++i) {
    if (i > 0) good = at != end && *at++ == 'x';
    const auto [next, failure] = std::from_chars(at, end, sides[i]);
    good = good && failure == std::errc() && sides[i] >= 2 && sides[i] <= 16384;
    at = next;
  }
  if (!good || at != end || sides[2] % 128 != 0)
    throw UsageError(
        fmt::format("{} {}: write ALPHAxTHETAxPHI, each 2..16384 voxels and PHI a multiple of 128, as in 1024x1024x512",
                    flag, text));
  return {.alpha = sides[0], .theta = sides[1], .phi = sides[2]};
}

}  // namespace

constinit const WrittenOption<VolumeSize> kVolumeSize(
    {.name = "vsv_size",
     .sentence = "size of the shadow volume, ALPHAxTHETAxPHI; PHI is a multiple of 128",
     .unit = "voxels",
     .results = InResults::OwnRows},
    {}, parseVolumeSize, volumeSizeName);

constinit const ChoiceOption<VolumeSource> kVolumeSource(
    {.name = "vsv_source", .sentence = "where the shadow volume's occluders come from", .results = InResults::OwnRows},
    VolumeSource::Direct,
    {{VolumeSource::Resample, "resample", "columns are looked up in a cube map of side --map-size"},
     {VolumeSource::Direct, "direct", "the scene itself, one ray-triangle test a column"}});

constinit const ChoiceOption<VolumeFit> kVolumeFit(
    {.name = "vsv_fit", .sentence = "what the shadow volume covers", .results = InResults::OwnRows}, VolumeFit::Frustum,
    {{VolumeFit::Frustum, "frustum", "what the camera sees, as far as the surfaces"},
     {VolumeFit::View, "view", "what it sees, however far"},
     {VolumeFit::Full, "full", "the whole sphere"}});

namespace {

class VolumeParameterization final : public Parameterization {
 public:
  const char* name() const override { return "vsv"; }
  const char* sentence() const override { return "an epipolar voxelized shadow volume, one bit a voxel"; }
  int sliceCount(const MapOptions&) const override { return 1; }

  LightSupport supportsLight(LightType type) const override {
    return type == LightType::Directional ? LightSupport::No : LightSupport::Yes;
  }

  LightModel lightModel(const Light& light, const glm::dvec3&) const override {
    return {.type = LightType::Point, .positionW = glm::dvec3(light.positionW)};
  }

  bool supportsBias(const BiasMethod& method) const override { return method.onVolumes; }
  bool supportsFilters() const override { return false; }

  FittedMap fit(const FitInput& input) const override {
    const MapOptions& options = input.options;
    FittedMap columns = fitVolume(input, options.get(kVolumeSize), options.get(kVolumeFit));
    if (options.get(kVolumeSource) == VolumeSource::Resample) {
      FitInput cube = input;
      // All of the scene casts into the whole sphere, and not only what stands before the camera's surfaces.
      if (options.get(kVolumeFit) == VolumeFit::Full) cube.receiversW = {};
      columns.occluderSource = std::make_shared<const FittedMap>(cubeParameterization().fit(cube));
    }
    return columns;
  }

  std::unique_ptr<Occluders> createOccluders(const gpu::Device& device, const FittedMap& fitted,
                                             ChannelSet channels) const override {
    GNOMON_CHECK_EQ(channels, glsl::kChannelDepth);
    return std::make_unique<ShadowVolume>(device, fitted);
  }

  std::vector<const MapOption*> options() const override { return {&kVolumeSize, &kVolumeSource, &kVolumeFit}; }
  MapOptions halved(const MapOptions& given) const override {
    return given.with(kVolumeSize(halvedSize(given.get(kVolumeSize))));
  }
  std::vector<std::pair<std::string, std::string>> fitParams(const FittedMap& fitted) const override {
    if (!fitted.occluderSource) return {};
    return {{"cube_size", fmt::format("{}", fitted.occluderSource->map.width)}};
  }
};

}  // namespace

const Parameterization& volumeParameterization() {
  static const VolumeParameterization volume;
  return volume;
}

}  // namespace gnomon
