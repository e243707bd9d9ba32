#include "planar/planar_map.h"

#include "base/error.h"
#include "planar/convex_body.h"
#include "planar/slice_points.h"
#include "planar/warp.h"
#include "planar/window.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include <fmt/format.h>

namespace gnomon {

constinit const ChoiceOption<WindowFit> kWindowFit(
    {.name = "fit", .sentence = "what spot and directional maps cover", .results = InResults::EveryRow},
    WindowFit::Focused,
    {{WindowFit::None, "none", "the whole cone or scene"},
     {WindowFit::Tight, "tight", "the part of the scene in the camera's frustum"},
     {WindowFit::Focused, "focused", "the visible surfaces that face the light"}});

constinit const ChoiceOption<bool> kSnap(
    {.name = "snap",
     .sentence = "texels of spot and directional maps keep their places in the world while the camera moves; costs "
                 "up to 9% of the resolution. Warped maps cannot snap",
     .results = InResults::EveryRow,
     .told =
         [](const MapOptions& options) { return kSnap.text(options.get(kSnap) && options.get(kWarp) == Warp::None); }},
    true, {{false, "off", "the tightest fit"}, {true, "on", "a grid that is fixed in the world"}});

constinit const NumberOption kCascades(
    {.name = "cascades",
     .sentence = "cascades of a directional map, split by the practical split scheme (Zhang et al. 2006); not with "
                 "--warp",
     .results = InResults::EveryRow},
    1, 1, kMostCascades);

namespace {

std::vector<const MapOption*> planarOptions() {
  return {&kWindowFit, &kSnap, &kWarp, &kCascades};
}

// A warp would shape every cascade to the whole view.
void checkPlanarOptions(const MapOptions& options) {
  kCascades.check(options.get(kCascades));
  if (options.get(kCascades) > 1 && options.get(kWarp) != Warp::None)
    throw UsageError(fmt::format("{} {} with {} {}: choose one of them; cascades are not warped", kCascades.flag(),
                                 options.text(kCascades), kWarp.flag(), options.text(kWarp)));
}

// The near and far ends are kept clear of the surfaces they were fitted to by a share of the range, far more
// than what 32-bit matrices round (1e-6) and far less than what costs precision.
constexpr double kRangeSlack = 1e-3;
// The least range, of the scene's diagonal: a plane across the light's axis has none.
constexpr double kLeastRange = 1e-6;
// A receiver this share of the window's half beyond its edge may still round into the slice.
constexpr double kEdgeSlack = 1e-3;

struct SliceFit {
  glm::dmat3 clipFromPlane{1.0};
  glm::dvec4 depthRow{0.0};  // of clipFromLight
  double zNear = 0.0;        // metres, of what the slice was fitted to
  double zFar = 1.0;
};

// Vulkan clip space from the light's frame. A row r of clipFromPlane is r.x x + r.y y + r.z (1 or -z).
glm::dvec4 lightRow(const glm::dvec3& r, bool perspective) {
  return perspective ? glm::dvec4(r.x, r.y, -r.z, 0.0) : glm::dvec4(r.x, r.y, 0.0, r.z);
}

glm::dmat4 clipFromLight(const SliceFit& slice, bool perspective) {
  const glm::dmat3 rows = glm::transpose(slice.clipFromPlane);
  return glm::transpose(glm::dmat4(lightRow(rows[0], perspective), lightRow(rows[1], perspective), slice.depthRow,
                                   lightRow(rows[2], perspective)));
}

glsl::LightFrame toShared(const AxisFrame& frame) {
  return {.originW = glm::vec3(frame.originW),
          .rightW = glm::vec3(frame.worldFromLight[0]),
          .upW = glm::vec3(frame.worldFromLight[1]),
          .backW = glm::vec3(frame.worldFromLight[2])};
}

struct Covered {
  double depth = 0.0;  // metres from the light's plane
  double w = 1.0;
};

// The receivers within a slice, whichever slice they were to go to: a finer slice answers for all it covers.
std::vector<Covered> coveredReceivers(const FitInput& input, const AxisFrame& frame, const glm::dmat3& clipFromPlane) {
  std::vector<Covered> covered;
  for (const glm::dvec3& receiver : input.receiversW) {
    const glm::dvec3 plane = frame.planeFromWorld(receiver);
    const glm::dvec3 clip = clipFromPlane * glm::dvec3(plane.x, plane.y, 1.0);
    const double most = clip.z * (1.0 + kEdgeSlack);
    if (plane.z > 0.0 || !frame.perspective)
      if (std::abs(clip.x) <= most && std::abs(clip.y) <= most) covered.push_back({.depth = plane.z, .w = clip.z});
  }
  return covered;
}

// Without a warp W is 1, and depth runs from 0 at zNear to 1 at zFar. With snapping the range is a step of a
// series, as the texel's size is.
void setDepthRow(SliceFit& slice, const AxisFrame& frame, double sceneScale, bool snap) {
  // Of what the slice holds alone, so that the near end stays where it is while the slice does.
  if (frame.perspective) slice.zNear *= 1.0 - kRangeSlack;
  double range = slice.zFar - slice.zNear;
  range = std::max(range * (1.0 + 2.0 * kRangeSlack), range + kLeastRange * sceneScale);
  if (snap) range = snapLength(range);
  if (!frame.perspective) slice.zNear -= kRangeSlack * range;
  slice.zFar = slice.zNear + range;
  slice.depthRow = frame.perspective ? glm::dvec4(0.0, 0.0, -slice.zFar, -slice.zFar * slice.zNear) / range
                                     : glm::dvec4(0.0, 0.0, -1.0, -slice.zNear) / range;
}

// A warped sun's depth is (depth - zNear) / (reach W), anchored at the near end, where floats are finest:
// what lies far from the camera, W large, has depths near 0 and keeps its digits. A warped spot's is 1 -
// (1/depth - 1/zFar) / (reach W), anchored at the far end: anchored at the near end it would reach 1 only
// beyond infinity where W is large.
void setWarpedDepthRow(SliceFit& slice, const FitInput& input, const AxisFrame& frame, double sceneScale,
                       std::span<const Covered> receivers, bool whole) {
  const bool spot = frame.perspective;
  if (spot)
    slice.zFar *= 1.0 + kRangeSlack;
  else
    slice.zNear -= kRangeSlack * (slice.zFar - slice.zNear);
  const double from = spot ? slice.zFar : slice.zNear;
  double reach = 0.0;
  if (spot || whole)
    reach =
        casterReach(input.scene, frame, slice.clipFromPlane, slice.zNear, from, spot ? Reach::Before : Reach::Behind);
  for (const Covered& receiver : receivers)
    reach = std::max(reach, std::abs(frame.linearDepth(receiver.depth) - frame.linearDepth(from)) / receiver.w);
  reach = std::max(reach * (1.0 + kRangeSlack), kLeastRange * (spot ? 1.0 / slice.zFar : sceneScale));
  slice.depthRow = spot ? lightRow(glm::transpose(slice.clipFromPlane)[2], true) -
                              glm::dvec4(0.0, 0.0, 1.0 / slice.zFar, 1.0) / reach
                        : glm::dvec4(0.0, 0.0, -1.0, -slice.zNear) / reach;
}

// From the nearest caster to the farthest receiver within the slice; but for a map that shall be whole (any
// fit but focused), to the farthest caster.
SliceFit fitDepth(const FitInput& input, const AxisFrame& frame, const Bounds& bounds,
                  const glm::dmat3& clipFromPlane) {
  const double sceneScale = std::max(static_cast<double>(bounds.diagonal()), 1e-6);
  const double least = frame.perspective ? leastCasterDepth(bounds) : -4.0 * sceneScale;
  const std::vector<Covered> receivers = coveredReceivers(input, frame, clipFromPlane);
  const bool whole = input.options.get(kWindowFit) != WindowFit::Focused || receivers.empty();
  SliceFit slice{.clipFromPlane = clipFromPlane, .zFar = frame.perspective ? least : -4.0 * sceneScale};
  for (const Covered& receiver : receivers) slice.zFar = std::max(slice.zFar, receiver.depth);
  if (whole) slice.zFar = farthestCasterDepth(input.scene, frame, clipFromPlane, slice.zFar);
  slice.zNear = nearestCasterDepth(input.scene, frame, clipFromPlane, least, slice.zFar);
  if (input.options.get(kWarp) == Warp::None)
    setDepthRow(slice, frame, sceneScale, input.options.get(kSnap));
  else
    setWarpedDepthRow(slice, input, frame, sceneScale, receivers, whole);
  return slice;
}

// Half a texel on every side keeps points on the very edge of the window inside.
glm::dmat3 fitWindow(const FitInput& input, const AxisFrame& frame, std::span<const glm::dvec2> points,
                     double sceneScale) {
  Window window = windowOf(points);
  const glm::dvec2 pad =
      (window.upper - window.lower) * (0.5 / input.side) + 1e-6 * (frame.perspective ? 1.0 : sceneScale);
  window = {.lower = window.lower - pad, .upper = window.upper + pad};
  return clipFromPlane(input.options.get(kSnap) ? snapWindow(window, input.side) : window);
}

// Of a spot, degrees, beyond which it is told: a texel at its axis then spans 1/cos^2(85 degrees) = 132 times the angle
// of one at its rim.
constexpr double kWideConeDegrees = 170.0;

std::string wideConeNote(const LightModel& light) {
  const double degrees = 2.0 * glm::degrees(light.outerConeRad);
  if (degrees <= kWideConeDegrees) return "";
  return fmt::format(
      "a cone of {:.4g} degrees on one plane leaves its rim most of the texels and its axis few; --maps cube does not, "
      "and --cone makes it narrower",
      degrees);
}

// Of slices finest first.
void setMap(FittedMap& fitted, const AxisFrame& frame, const Bounds& bounds, int side,
            std::span<const SliceFit> slices) {
  fitted.frame = toShared(frame);
  fitted.positional = frame.perspective;
  fitted.zNear = static_cast<float>(slices[0].zNear);
  fitted.zFar = static_cast<float>(slices[0].zFar);
  fitted.map = {};
  fitted.map.kind = glsl::kMapPlanar;
  fitted.map.sliceCount = static_cast<int>(slices.size());
  fitted.map.width = fitted.map.height = side;
  fitted.map.sceneScale = bounds.diagonal();
  for (size_t i = 0; i < slices.size(); ++i) {
    // The inverse is that of the rounded matrix, which is what the map is drawn with.
    const glm::mat4 clip(clipFromLight(slices[i], frame.perspective));
    fitted.map.mapSlices[i] = {.clipFromLight = clip, .lightFromClip = glm::mat4(glm::inverse(glm::dmat4(clip)))};
  }
}

FittedMap fitPlanar(const FitInput& input, bool perspective, int cascadeCount) {
  checkPlanarOptions(input.options);
  const Bounds bounds = computeBounds(input.scene);
  const double sceneScale = std::max(static_cast<double>(bounds.diagonal()), 1e-6);
  const glm::dvec3 origin = perspective ? input.light.positionW : glm::dvec3(bounds.center());
  const AxisFrame frame = axisFrame(origin, input.light.directionW, perspective);

  const Warp warp = input.options.get(kWarp);
  FittedMap fitted;
  if (perspective) fitted.note = wideConeNote(input.light);
  std::vector<glm::dmat3> planes;
  for (const std::vector<glm::dvec2>& points : slicePoints(input, frame, bounds, cascadeCount)) {
    WarpedPlane warped;
    if (warp != Warp::None) {
      const std::vector<glm::dvec2> hull = convexHull(points);
      warped = warpPlane(
          warp,
          {.frame = frame, .camera = input.camera, .points = hull, .receiversW = input.receiversW, .side = input.side});
      if (!warped.note.empty()) fitted.note = warped.note;
    }
    planes.push_back(warped.warped ? warped.clipFromPlane : fitWindow(input, frame, points, sceneScale));
  }
  // Finest first: of the windows that hold a point the first is taken. Texels are small where the scale is large.
  std::ranges::stable_sort(planes, std::ranges::greater(),
                           [](const glm::dmat3& m) { return std::abs(glm::determinant(m)); });
  std::vector<SliceFit> slices;
  for (const glm::dmat3& plane : planes) slices.push_back(fitDepth(input, frame, bounds, plane));
  setMap(fitted, frame, bounds, input.side, slices);
  return fitted;
}

// The part of the bounds that a map of theirs is to cover.
ConvexBody coveredBody(const FitInput& input, const AxisFrame& frame, const Bounds& bounds, bool cameraCuts) {
  ConvexBody body(bounds);
  if (cameraCuts) cutToView(body, input.camera);
  if (frame.perspective) cutToCone(body, input.light, frame, leastCasterDepth(bounds));
  return body;
}

// Depth at which the bounds begin within a directional window, metres.
double nearestOfBounds(const Bounds& bounds, const AxisFrame& frame, const glm::dmat3& clipFromPlane) {
  ConvexBody body(bounds);
  const glm::dmat3 rows = glm::transpose(clipFromPlane);
  for (int axis = 0; axis < 2; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const glm::dvec3 row = rows[2] + sign * rows[axis];  // W +- X >= 0
      const glm::dvec3 normal = frame.worldFromLight[0] * row.x + frame.worldFromLight[1] * row.y;
      body.cut(normal, row.z - glm::dot(normal, frame.originW));
    }
  }
  double nearest = std::numeric_limits<double>::max();
  for (const glm::dvec3& corner : body.corners()) nearest = std::min(nearest, frame.planeFromWorld(corner).z);
  return nearest;
}

FittedMap fitToBounds(const LightModel& light, const BoundsFit& fit, bool perspective) {
  const Bounds& bounds = fit.boundsW;
  const double sceneScale = std::max(static_cast<double>(bounds.diagonal()), 1e-6);
  const AxisFrame frame =
      axisFrame(perspective ? light.positionW : glm::dvec3(bounds.center()), light.directionW, perspective);
  const Scene none;
  const glsl::CameraView anywhere{};
  FitInput input{.scene = none,
                 .light = light,
                 .receiversW = {},
                 .side = fit.side,
                 .camera = fit.camera != nullptr ? *fit.camera : anywhere};
  input.options.set(kSnap(fit.snap));
  const std::vector<glm::dvec3> corners = coveredBody(input, frame, bounds, fit.camera != nullptr).corners();
  std::vector<glm::dvec2> points;
  double farthest = perspective ? leastCasterDepth(bounds) : -4.0 * sceneScale;  // as fitDepth() has it
  for (const glm::dvec3& corner : corners) {
    const glm::dvec3 plane = frame.planeFromWorld(corner);
    points.emplace_back(plane);
    farthest = std::max(farthest, plane.z);
  }
  if (points.empty()) points = {glm::dvec2(-1.0), glm::dvec2(1.0)};  // nothing to cover, as in slicePoints()
  SliceFit slice{.clipFromPlane = fitWindow(input, frame, points, sceneScale), .zFar = farthest};
  slice.zNear = perspective ? std::min(std::max(fit.zNear, leastCasterDepth(bounds)), farthest)
                            : std::min(nearestOfBounds(bounds, frame, slice.clipFromPlane), farthest);
  setDepthRow(slice, frame, sceneScale, fit.snap);
  FittedMap fitted;
  if (perspective) fitted.note = wideConeNote(light);
  setMap(fitted, frame, bounds, fit.side, {&slice, 1});
  return fitted;
}

class SpotParameterization final : public Parameterization {
 public:
  const char* name() const override { return "spot"; }
  const char* sentence() const override { return "one perspective projection of a cone"; }
  int sliceCount(const MapOptions&) const override { return 1; }

  LightSupport supportsLight(LightType type) const override {
    return type == LightType::Directional ? LightSupport::No : LightSupport::Yes;
  }

  bool needsAim(LightType type) const override { return type == LightType::Point; }

  LightModel lightModel(const Light& light, const glm::dvec3& aimW) const override {
    return {.type = LightType::Spot,
            .positionW = glm::dvec3(light.positionW),
            .directionW = light.type == LightType::Spot ? glm::normalize(glm::dvec3(light.directionW)) : aimW,
            .outerConeRad = static_cast<double>(light.outerConeRad)};
  }

  FittedMap fit(const FitInput& input) const override { return fitPlanar(input, true, 1); }
  std::vector<const MapOption*> options() const override { return planarOptions(); }
  void checkOptions(const MapOptions& options) const override { checkPlanarOptions(options); }
};

class DirectionalParameterization final : public Parameterization {
 public:
  const char* name() const override { return "directional"; }
  const char* sentence() const override {
    return "one orthographic projection; a point or spot light is treated as a sun from the same side";
  }
  int sliceCount(const MapOptions& options) const override { return options.get(kCascades); }

  LightSupport supportsLight(LightType type) const override {
    return type == LightType::Directional ? LightSupport::Yes : LightSupport::Fallback;
  }

  bool needsAim(LightType type) const override { return type == LightType::Point; }

  LightModel lightModel(const Light& light, const glm::dvec3& aimW) const override {
    return {.type = LightType::Directional,
            .directionW = light.type == LightType::Point ? aimW : glm::normalize(glm::dvec3(light.directionW))};
  }

  FittedMap fit(const FitInput& input) const override { return fitPlanar(input, false, input.options.get(kCascades)); }
  std::vector<const MapOption*> options() const override { return planarOptions(); }
  void checkOptions(const MapOptions& options) const override { checkPlanarOptions(options); }
};

}  // namespace

FittedMap makeSpotMap(const LightModel& light, const BoundsFit& fit) {
  return fitToBounds(light, fit, true);
}

FittedMap makeDirectionalMap(const LightModel& light, const BoundsFit& fit) {
  return fitToBounds(light, fit, false);
}

const Parameterization& spotParameterization() {
  static const SpotParameterization spot;
  return spot;
}

const Parameterization& directionalParameterization() {
  static const DirectionalParameterization directional;
  return directional;
}

const std::vector<const Parameterization*>& planarParameterizations() {
  static const std::vector<const Parameterization*> both = {&spotParameterization(), &directionalParameterization()};
  return both;
}

}  // namespace gnomon
