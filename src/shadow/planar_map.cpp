#include "shadow/planar_map.h"

#include "shadow/fit.h"
#include "shadow/layer_points.h"
#include "shadow/warp.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace gnomon {

namespace {

// The near and far ends are kept clear of the surfaces they were fitted to by a share of the range, far more
// than what 32-bit matrices round (1e-6) and far less than what costs precision.
constexpr double kRangeSlack = 1e-3;
// The least range, of the scene's diagonal: a plane across the light's axis has none.
constexpr double kLeastRange = 1e-6;
// A receiver this share of the window's half beyond its edge may still round into the layer.
constexpr double kEdgeSlack = 1e-3;

// Depth stored is scale (linearDepth - linearDepth(zNear)) / W: 0 at zNear on every ray of the layer.
struct LayerFit {
  glm::dmat3 clipFromPlane{1.0};
  double zNear = 0.0;
  double zFar = 1.0;  // of what the layer was fitted to
  double scale = 1.0;
};

// Vulkan clip space from the light's frame. A row r of clipFromPlane is r.x x + r.y y + r.z (1 or -z), the
// row of depth scale (-z - n) or, times the distance that the perspective divides by, scale (-z / n - 1).
glm::dmat4 clipFromLight(const LayerFit& layer, bool perspective) {
  const glm::dmat3& p = layer.clipFromPlane;
  glm::dmat4 m(0.0);
  for (int column = 0; column < 2; ++column) m[column] = {p[column].x, p[column].y, 0.0, p[column].z};
  if (perspective) {
    m[2] = {-p[2].x, -p[2].y, -layer.scale / layer.zNear, -p[2].z};
    m[3] = {0.0, 0.0, -layer.scale, 0.0};
  } else {
    m[2] = {0.0, 0.0, -layer.scale, 0.0};
    m[3] = {p[2].x, p[2].y, -layer.scale * layer.zNear, p[2].z};
  }
  return m;
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

// The receivers within a layer, whichever layer they were to go to: a finer layer answers for all it covers.
std::vector<Covered> coveredReceivers(const FitInput& input, const AxisFrame& frame,
                                      const glm::dmat3& clipFromPlane) {
  std::vector<Covered> covered;
  for (const glm::dvec3& receiver : input.receiversW) {
    const glm::dvec3 plane = frame.planeFromWorld(receiver);
    const glm::dvec3 clip = clipFromPlane * glm::dvec3(plane.x, plane.y, 1.0);
    const double most = clip.z * (1.0 + kEdgeSlack);
    if (plane.z > 0.0 || !frame.perspective)
      if (std::abs(clip.x) <= most && std::abs(clip.y) <= most)
        covered.push_back({.depth = plane.z, .w = clip.z});
  }
  return covered;
}

// From the nearest caster to the farthest receiver within the layer; but for a map that shall be whole (any
// fit but focused), to the farthest caster. With snapping the range is a step of a series, as the texel's
// size is.
LayerFit fitDepth(const FitInput& input, const AxisFrame& frame, const Bounds& bounds,
                  const glm::dmat3& clipFromPlane) {
  const double sceneScale = std::max(static_cast<double>(bounds.diagonal()), 1e-6);
  const double least = frame.perspective ? leastCasterDepth(bounds) : -4.0 * sceneScale;
  const std::vector<Covered> receivers = coveredReceivers(input, frame, clipFromPlane);
  double farthest = frame.perspective ? least : -sceneScale;
  for (const Covered& receiver : receivers) farthest = std::max(farthest, receiver.depth);
  const bool whole = input.options.fit != WindowFit::Focused || receivers.empty();
  double nearest = nearestCasterDepth(input.scene, frame, clipFromPlane, least, whole ? 1e30 : farthest);
  if (nearest >= 1e30) nearest = farthest;
  if (frame.perspective) nearest *= 1.0 - kRangeSlack;

  // W is 1 everywhere but in a warped layer, so that there a reach is a length, or an inverse length.
  double reach = whole ? farthestCasterReach(input.scene, frame, clipFromPlane, nearest) : 0.0;
  for (const Covered& receiver : receivers)
    reach = std::max(reach, (frame.linearDepth(receiver.depth) - frame.linearDepth(nearest)) / receiver.w);
  LayerFit layer{.clipFromPlane = clipFromPlane, .zNear = nearest};
  if (input.options.warp != Warp::None) {
    layer.zFar = std::max(farthest, nearest);
    reach = std::max(reach, kLeastRange * (frame.perspective ? 1.0 / nearest : sceneScale));
    if (!frame.perspective) layer.zNear -= kRangeSlack * reach * wRange(clipFromPlane).least;
    layer.scale = 1.0 / (reach * (1.0 + 2.0 * kRangeSlack));
    return layer;
  }
  const double end = frame.perspective ? 1.0 / (1.0 / nearest - reach) : nearest + reach;
  double range =
      std::max((end - nearest) * (1.0 + 2.0 * kRangeSlack), end - nearest + kLeastRange * sceneScale);
  if (snaps(input.options)) range = snapLength(range);
  if (!frame.perspective) layer.zNear -= kRangeSlack * range;
  layer.zFar = layer.zNear + range;
  layer.scale = 1.0 / (frame.linearDepth(layer.zFar) - frame.linearDepth(layer.zNear));
  return layer;
}

// Half a texel on every side keeps points on the very edge of the window inside.
glm::dmat3 fitWindow(const FitInput& input, const AxisFrame& frame, std::span<const glm::dvec2> points,
                     double sceneScale) {
  Window window = windowOf(points);
  const glm::dvec2 pad =
      (window.upper - window.lower) * (0.5 / input.side) + 1e-6 * (frame.perspective ? 1.0 : sceneScale);
  window = {.lower = window.lower - pad, .upper = window.upper + pad};
  return clipFromPlane(input.options.snap ? snapWindow(window, input.side) : window);
}

FittedMap fitPlanar(const FitInput& input, bool perspective, int cascadeCount) {
  checkMapOptions(input.options);
  const Bounds bounds = computeBounds(input.scene);
  const double sceneScale = std::max(static_cast<double>(bounds.diagonal()), 1e-6);
  const glm::dvec3 origin = perspective ? input.light.positionW : glm::dvec3(bounds.center());
  const AxisFrame frame = axisFrame(origin, input.light.directionW, perspective);

  FittedMap fitted;
  std::vector<glm::dmat3> planes;
  for (const std::vector<glm::dvec2>& points : layerPoints(input, frame, bounds, cascadeCount)) {
    WarpedPlane warped;
    if (input.options.warp != Warp::None) {
      const std::vector<glm::dvec2> hull = convexHull(points);
      warped = warpPlane(input.options.warp, {.frame = frame,
                                              .camera = input.camera,
                                              .points = hull,
                                              .receiversW = input.receiversW,
                                              .side = input.side});
      fitted.note = warped.note;
    }
    planes.push_back(warped.warped ? warped.clipFromPlane : fitWindow(input, frame, points, sceneScale));
  }
  // Finest first: of the windows that hold a point the first is taken. Texels are small where the scale is
  // large.
  std::ranges::stable_sort(planes, std::ranges::greater(),
                           [](const glm::dmat3& m) { return std::abs(glm::determinant(m)); });

  fitted.frame = toShared(frame);
  fitted.map = {};
  fitted.map.kind = glsl::kMapPlanar;
  fitted.map.layerCount = cascadeCount;
  fitted.map.side = input.side;
  fitted.map.sceneScale = bounds.diagonal();
  for (size_t i = 0; i < planes.size(); ++i) {
    const LayerFit layer = fitDepth(input, frame, bounds, planes[i]);
    if (i == 0) {
      fitted.zNear = static_cast<float>(layer.zNear);
      fitted.zFar = static_cast<float>(layer.zFar);
    }
    // The inverse is that of the rounded matrix, which is what the map is drawn with.
    const glm::mat4 clip(clipFromLight(layer, perspective));
    fitted.map.mapLayers[i] = {.clipFromLight = clip,
                               .lightFromClip = glm::mat4(glm::inverse(glm::dmat4(clip)))};
  }
  return fitted;
}

class SpotParameterization final : public Parameterization {
 public:
  const char* name() const override { return "spot"; }
  const char* sentence() const override { return "one perspective layer within a cone"; }
  int layerCount(const MapOptions&) const override { return 1; }

  Takes takes(LightType type) const override {
    return type == LightType::Directional ? Takes::No : Takes::Yes;
  }

  LightModel lightModel(const Light& light, const glm::dvec3& aimW) const override {
    return {.type = LightType::Spot,
            .positionW = glm::dvec3(light.positionW),
            .directionW = light.type == LightType::Spot ? glm::normalize(glm::dvec3(light.directionW)) : aimW,
            .outerConeRad = static_cast<double>(light.outerConeRad)};
  }

  FittedMap fit(const FitInput& input) const override { return fitPlanar(input, true, 1); }
};

class DirectionalParameterization final : public Parameterization {
 public:
  const char* name() const override { return "directional"; }
  const char* sentence() const override {
    return "one orthographic layer; a positional light becomes a sun from its side";
  }
  int layerCount(const MapOptions& options) const override { return options.cascades; }

  Takes takes(LightType type) const override {
    return type == LightType::Directional ? Takes::Yes : Takes::IfNothingElse;
  }

  LightModel lightModel(const Light& light, const glm::dvec3& aimW) const override {
    return {
        .type = LightType::Directional,
        .directionW = light.type == LightType::Point ? aimW : glm::normalize(glm::dvec3(light.directionW))};
  }

  FittedMap fit(const FitInput& input) const override {
    return fitPlanar(input, false, input.options.cascades);
  }
};

}  // namespace

const Parameterization& spotParameterization() {
  static const SpotParameterization spot;
  return spot;
}

const Parameterization& directionalParameterization() {
  static const DirectionalParameterization directional;
  return directional;
}

const std::vector<const Parameterization*>& planarParameterizations() {
  static const std::vector<const Parameterization*> both = {&spotParameterization(),
                                                            &directionalParameterization()};
  return both;
}

}  // namespace gnomon
