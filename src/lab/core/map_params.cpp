#include "lab/core/map_params.h"

#include <fmt/format.h>

namespace gnomon {

namespace {

using Params = std::vector<std::pair<std::string, std::string>>;

Params volumeParams(const FittedMap& fitted, const MapOptions& options) {
  Params params = {{"vsv_size", volumeSizeName(options.volumeSize)},
                   {"vsv_source", volumeSourceName(options.volumeSource)},
                   {"vsv_fit", volumeFitName(options.volumeFit)}};
  if (options.volumeSource == VolumeSource::Resample)
    params.emplace_back("cube_size", fmt::format("{}", fitted.occluderSource->map.side));
  return params;
}

Params cubeParams(const MapOptions& options) {
  const MapOptions defaults;
  Params params;
  if (options.cubeDepth != defaults.cubeDepth) params.emplace_back("cube_depth", cubeDepthName(options.cubeDepth));
  if (options.cubePasses != defaults.cubePasses) params.emplace_back("cube_passes", cubePassesName(options.cubePasses));
  return params;
}

Params paraboloidParams(const MapOptions& options) {
  const MapOptions defaults;
  Params params;
  if (options.paraboloidRaster != defaults.paraboloidRaster)
    params.emplace_back("paraboloid_raster", paraboloidRasterName(options.paraboloidRaster));
  if (options.paraboloidAxisW) {
    const glm::dvec3& axis = *options.paraboloidAxisW;
    params.emplace_back("paraboloid_axis", fmt::format("{:.6g},{:.6g},{:.6g}", axis.x, axis.y, axis.z));
  }
  return params;
}

}  // namespace

Params mapParams(const FittedMap& fitted, const MapOptions& options) {
  switch (fitted.map.kind) {
    case glsl::kMapEpipolar:
      return volumeParams(fitted, options);
    case glsl::kMapCube:
    case glsl::kMapCubeRadial:
      return cubeParams(options);
    case glsl::kMapParaboloid:
      return paraboloidParams(options);
    default:
      return {};
  }
}

}  // namespace gnomon
