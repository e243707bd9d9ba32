#include "shadow/map_options.h"

#include "base/error.h"

#include <algorithm>
#include <charconv>
#include <span>

#include <fmt/format.h>

namespace gnomon {

namespace {

// In the order of the enumerations.
constexpr std::array<const char*, 3> kWindowFitNames = {"none", "tight", "focused"};
constexpr std::array<const char*, 4> kWarpNames = {"none", "psm", "lispsm", "tsm"};
constexpr std::array<const char*, 2> kSnapNames = {"off", "on"};
constexpr std::array<const char*, 2> kCubeDepthNames = {"hyperbolic", "radial"};
constexpr std::array<const char*, 3> kCubePassesNames = {"auto", "six", "multiview"};
constexpr std::array<const char*, 3> kParaboloidRasterNames = {"vertex", "tessellated", "exact"};

constexpr std::array<const char*, 2> kVolumeSourceNames = {"resample", "direct"};
constexpr std::array<const char*, 2> kVolumeFitNames = {"frustum", "full"};

size_t parseName(const char* flag, const std::string& name, std::span<const char* const> names) {
  std::string choices;
  for (size_t i = 0; i < names.size(); ++i) {
    if (name == names[i]) return i;
    choices += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  throw UsageError(fmt::format("{} {}: no such choice; choose from {}", flag, name, choices));
}

}  // namespace

void checkMapOptions(const MapOptions& options) {
  if (options.cascades < 1 || options.cascades > kMostCascades)
    throw UsageError(fmt::format("--cascades {}: is outside 1..{}", options.cascades, kMostCascades));
  if (options.cascades > 1 && options.warp != Warp::None)
    throw UsageError(fmt::format("--cascades {} with --warp {}: choose one of them; cascades are not warped",
                                 options.cascades, warpName(options.warp)));
}

bool snaps(const MapOptions& options) {
  return options.snap && options.warp == Warp::None;
}

WindowFit parseWindowFit(const std::string& name) {
  return static_cast<WindowFit>(parseName("--fit", name, kWindowFitNames));
}
Warp parseWarp(const std::string& name) {
  return static_cast<Warp>(parseName("--warp", name, kWarpNames));
}
bool parseSnap(const std::string& name) {
  return parseName("--snap", name, kSnapNames) == 1;
}
CubeDepth parseCubeDepth(const std::string& name) {
  return static_cast<CubeDepth>(parseName("--cube-depth", name, kCubeDepthNames));
}
LayerPasses parseCubePasses(const std::string& name) {
  return static_cast<LayerPasses>(parseName("--cube-passes", name, kCubePassesNames));
}
ParaboloidRaster parseParaboloidRaster(const std::string& name) {
  return static_cast<ParaboloidRaster>(parseName("--paraboloid-raster", name, kParaboloidRasterNames));
}
VolumeSource parseVolumeSource(const std::string& name) {
  return static_cast<VolumeSource>(parseName("--vsv-source", name, kVolumeSourceNames));
}
VolumeFit parseVolumeFit(const std::string& name) {
  return static_cast<VolumeFit>(parseName("--vsv-fit", name, kVolumeFitNames));
}

VolumeSize parseVolumeSize(const std::string& text) {
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
        fmt::format("--vsv-size {}: write ALPHAxTHETAxPHI, each 2..16384 voxels and PHI a multiple of 128, "
                    "as in 1024x1024x512",
                    text));
  return {.alpha = sides[0], .theta = sides[1], .phi = sides[2]};
}

const char* windowFitName(WindowFit fit) {
  return kWindowFitNames[static_cast<size_t>(fit)];
}
const char* warpName(Warp warp) {
  return kWarpNames[static_cast<size_t>(warp)];
}
const char* cubeDepthName(CubeDepth depth) {
  return kCubeDepthNames[static_cast<size_t>(depth)];
}
const char* cubePassesName(LayerPasses passes) {
  return kCubePassesNames[static_cast<size_t>(passes)];
}
const char* paraboloidRasterName(ParaboloidRaster raster) {
  return kParaboloidRasterNames[static_cast<size_t>(raster)];
}
VolumeSize halvedSize(const VolumeSize& size) {
  return {.alpha = std::max(size.alpha / 2, 2),
          .theta = std::max(size.theta / 2, 2),
          .phi = std::max(size.phi / 256 * 128, 128)};
}
std::string volumeSizeName(const VolumeSize& size) {
  return fmt::format("{}x{}x{}", size.alpha, size.theta, size.phi);
}
const char* volumeSourceName(VolumeSource source) {
  return kVolumeSourceNames[static_cast<size_t>(source)];
}
const char* volumeFitName(VolumeFit fit) {
  return kVolumeFitNames[static_cast<size_t>(fit)];
}

}  // namespace gnomon
