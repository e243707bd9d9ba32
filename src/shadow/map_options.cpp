#include "shadow/map_options.h"

#include "base/error.h"

#include <span>

#include <fmt/format.h>

namespace gnomon {

namespace {

// In the order of the enumerations.
constexpr std::array<const char*, 3> kWindowFitNames = {"none", "tight", "focused"};
constexpr std::array<const char*, 4> kWarpNames = {"none", "psm", "lispsm", "tsm"};
constexpr std::array<const char*, 2> kSnapNames = {"off", "on"};
constexpr std::array<const char*, 2> kCubeDepthNames = {"hyperbolic", "radial"};
constexpr std::array<const char*, 3> kParaboloidRasterNames = {"vertex", "tessellated", "exact"};

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
ParaboloidRaster parseParaboloidRaster(const std::string& name) {
  return static_cast<ParaboloidRaster>(parseName("--paraboloid-raster", name, kParaboloidRasterNames));
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
const char* paraboloidRasterName(ParaboloidRaster raster) {
  return kParaboloidRasterNames[static_cast<size_t>(raster)];
}

}  // namespace gnomon
