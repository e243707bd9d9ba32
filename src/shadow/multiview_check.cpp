#include "shadow/multiview_check.h"

#include "scene/mesh_builder.h"
#include "shadow/map_image.h"

#include <algorithm>
#include <limits>

namespace gnomon {

namespace {

constexpr int kSmallSide = 64;  // texels
// As many triangles as a small level has, on slices of a usual size: what is compared is the cost of vertices
// against that of passes, and both grow with the scene.
constexpr int kManySegments = 256, kManyRings = 129;  // 65,536 triangles
constexpr int kFewSegments = 16, kFewRings = 9;       // 256 triangles
constexpr int kRounds = 5;

// A sphere around the light half way between the ends of depth, so that all slices see some of it, and a
// floor of two triangles much larger than what lies below the light.
SceneBuffers sphereAndFloor(const gpu::Device& device, const FittedMap& fitted, int segments, int rings) {
  Scene scene;
  scene.materials.push_back({.name = "grey", .doubleSided = true});
  MeshBuilder builder("sphere and floor", 0);
  const glm::dvec3 lightW(fitted.frame.originW);
  const double middle = 0.5 * (static_cast<double>(fitted.zNear) + fitted.zFar), wide = 4.0 * fitted.zFar;
  builder.sphere(lightW, middle, segments, rings);
  const auto floor = [&](double x, double z) { return lightW + glm::dvec3(x, -0.9 * middle, z); };
  builder.quad(floor(-wide, -wide), floor(-wide, wide), floor(wide, wide), floor(wide, -wide));
  scene.meshes.push_back(builder.build());
  scene.instances.push_back({.name = "", .mesh = 0});
  return createSceneBuffers(device, scene);
}

// Where a slice shows nothing there is nothing to compare.
bool anySliceIsEmpty(const std::vector<float>& depths, int sliceCount) {
  const auto texels = static_cast<std::ptrdiff_t>(depths.size()) / sliceCount;
  for (auto slice = depths.begin(); slice != depths.end(); slice += texels)
    if (std::all_of(slice, slice + texels, [](float depth) { return depth == 1.0f; })) return true;
  return false;
}

FittedMap ofSide(FittedMap fitted, int side) {
  fitted.map.width = fitted.map.height = side;
  return fitted;
}

}  // namespace

MultiviewCheck checkMultiview(const gpu::Device& device, const FittedMap& fitted, const DrawSlices& draw) {
  const auto drawsAlike = [&](const SceneBuffers& scene, const FittedMap& shape) {
    MapImage each(device, shape), together(device, shape);
    draw(scene, each, false);
    draw(scene, together, true);
    const auto depths = gpu::downloadAs<float>(device, each.depth());
    return depths == gpu::downloadAs<float>(device, together.depth()) && !anySliceIsEmpty(depths, each.sliceCount());
  };
  if (!drawsAlike(sphereAndFloor(device, fitted, kFewSegments, kFewRings), ofSide(fitted, kSmallSide))) return {};
  const SceneBuffers many = sphereAndFloor(device, fitted, kManySegments, kManyRings);
  if (!drawsAlike(many, fitted)) return {};
  MapImage map(device, fitted);
  double eachMs = std::numeric_limits<double>::infinity(), togetherMs = eachMs;
  for (int round = 0; round < kRounds; ++round) {
    eachMs = std::min(eachMs, draw(many, map, false));
    togetherMs = std::min(togetherMs, draw(many, map, true));
  }
  return {.same = true, .faster = togetherMs < eachMs};
}

}  // namespace gnomon
