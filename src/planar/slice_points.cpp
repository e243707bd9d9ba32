#include "planar/slice_points.h"

#include "planar/cascades.h"
#include "planar/convex_body.h"
#include "planar/planar_map.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

using Points = std::vector<glm::dvec2>;

// A point light cannot stand nearer to a caster than this share of the scene's diagonal.
constexpr double kLeastNear = 1e-5;

// A file may say that a spot shines to all sides of a half space, which no window holds.
constexpr double kWidestConeRad = 1.5533430342749532;  // 89 degrees

struct Slice {
  double nearest = 0.0;  // view depths, metres
  double farthest = 0.0;
};

// The first slice begins at the camera and the last has no end, so that together they hold all that is seen.
std::vector<Slice> viewSlices(const FitInput& input, int count) {
  double nearest = 1e30;
  double farthest = 0.0;
  for (const glm::dvec3& receiver : input.receiversW) {
    nearest = std::min(nearest, viewDepth(input.camera, receiver));
    farthest = std::max(farthest, viewDepth(input.camera, receiver));
  }
  std::vector<Slice> slices(static_cast<size_t>(count), {0.0, 1e30});
  if (input.receiversW.empty() || !(nearest > 0.0)) return slices;
  const std::vector<double> splits = cascadeSplits(nearest, farthest, count);
  for (size_t i = 1; i < slices.size(); ++i) slices[i - 1].farthest = slices[i].nearest = splits[i];
  return slices;
}

double tanCone(const LightModel& light) {
  return std::tan(std::min(light.outerConeRad, kWidestConeRad));
}

void addTight(Points& points, const FitInput& input, const AxisFrame& frame, const Bounds& bounds, const Slice& slice) {
  ConvexBody body(bounds);
  cutToView(body, input.camera, slice.nearest, slice.farthest);
  if (frame.perspective) cutToCone(body, input.light, frame, leastCasterDepth(bounds));
  for (const glm::dvec3& corner : body.corners()) points.emplace_back(frame.planeFromWorld(corner));
}

void addWhole(Points& points, const FitInput& input, const AxisFrame& frame, const Bounds& bounds) {
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 corner((i & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                           (i & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                           (i & 4) != 0 ? bounds.upper.z : bounds.lower.z);
    if (!frame.perspective)
      points.emplace_back(frame.planeFromWorld(glm::dvec3(corner)));
    else if (i < 4)
      points.emplace_back(tanCone(input.light) * glm::dvec2((i & 1) * 2 - 1, (i & 2) - 1));
  }
}

}  // namespace

double leastCasterDepth(const Bounds& sceneBounds) {
  return kLeastNear * std::max(static_cast<double>(sceneBounds.diagonal()), 1e-30);
}

void cutToView(ConvexBody& body, const glsl::CameraView& camera, double nearest, double farthest) {
  // clipFromWorld maps to reversed depth without a far end: z is the near plane's distance everywhere.
  const double nearPlane = static_cast<double>(camera.clipFromWorld[3][2]);
  body.cutToCamera(camera, std::max(nearest, nearPlane), farthest);
}

void cutToCone(ConvexBody& body, const LightModel& light, const AxisFrame& frame, double least) {
  const double width = tanCone(light);
  const auto cutThroughLight = [&](const glm::dvec3& normal, double offset) {
    body.cut(normal, -glm::dot(normal, frame.originW) + offset);
  };
  const glm::dvec3 ahead = -frame.worldFromLight[2];
  for (const double sign : {1.0, -1.0})
    for (int axis = 0; axis < 2; ++axis) cutThroughLight(ahead * width + sign * frame.worldFromLight[axis], 0.0);
  cutThroughLight(ahead, -least);
}

std::vector<std::vector<glm::dvec2>> slicePoints(const FitInput& input, const AxisFrame& frame,
                                                 const Bounds& sceneBounds, int cascadeCount) {
  const std::vector<Slice> slices = viewSlices(input, cascadeCount);
  std::vector<Points> result(slices.size());
  for (size_t i = 0; i < slices.size(); ++i) {
    const bool whole = input.options.get(kWindowFit) == WindowFit::None && i + 1 == slices.size();
    if (whole)
      addWhole(result[i], input, frame, sceneBounds);
    else if (input.options.get(kWindowFit) != WindowFit::Focused)
      addTight(result[i], input, frame, sceneBounds, slices[i]);
  }
  // Receivers are in every fit: what rounds out of a body's edge is covered all the same.
  for (const glm::dvec3& receiver : input.receiversW) {
    const double depth = viewDepth(input.camera, receiver);
    const auto slice = std::ranges::find_if(slices, [&](const Slice& s) { return depth < s.farthest; });
    result[static_cast<size_t>(slice - slices.begin())].emplace_back(frame.planeFromWorld(receiver));
  }
  // One unit around the axis where there is nothing to cover at all.
  if (result.back().empty()) result.back() = {glm::dvec2(-1.0), glm::dvec2(1.0)};
  for (size_t i = result.size() - 1; i-- > 0;)
    if (result[i].empty()) result[i] = result[i + 1];
  return result;
}

}  // namespace gnomon
