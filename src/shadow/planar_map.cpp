#include "shadow/planar_map.h"

#include "shadow/fit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

// The near and far ends are kept clear of the surfaces they were fitted to by a share of the range, far more
// than what 32-bit matrices round (1e-6) and far less than what costs precision.
constexpr double kRangeSlack = 1e-3;
// A point light cannot stand nearer to a caster than this share of the scene's diagonal.
constexpr double kLeastNear = 1e-5;

struct DepthRange {
  double zNear = 0.0;
  double zFar = 1.0;
};

// Vulkan clip space from the light's frame; the picture of a layer stands upright (y down in clip space).
glm::dmat4 clipFromLight(const Window& window, const DepthRange& range, bool perspective) {
  const glm::dvec2 scale = 2.0 / (window.upper - window.lower);
  const glm::dvec2 center = 0.5 * (window.upper + window.lower);
  const double span = range.zFar - range.zNear;
  glm::dmat4 m(0.0);
  m[0][0] = scale.x;
  m[1][1] = -scale.y;
  if (perspective) {  // depth = -z; x_clip = scale * (x - center * depth), z_clip = f (depth - n) / (f - n),
                      // w = depth
    m[2] = {scale.x * center.x, -scale.y * center.y, -range.zFar / span, -1.0};
    m[3] = {0.0, 0.0, -range.zFar * range.zNear / span, 0.0};
  } else {
    m[2][2] = -1.0 / span;
    m[3] = {-scale.x * center.x, scale.y * center.y, -range.zNear / span, 1.0};
  }
  return m;
}

// Bounds of the receivers in the plane, and their depths.
struct ReceiverBounds {
  Window window{.lower = glm::dvec2(1e30), .upper = glm::dvec2(-1e30)};
  double zMin = 1e30;
  double zMax = -1e30;
};

ReceiverBounds receiverBounds(const FitInput& input, const AxisFrame& frame) {
  ReceiverBounds bounds;
  for (const glm::dvec3& receiver : input.receiversW) {
    const glm::dvec3 p = frame.planeFromWorld(receiver);
    bounds.window.lower = glm::min(bounds.window.lower, glm::dvec2(p));
    bounds.window.upper = glm::max(bounds.window.upper, glm::dvec2(p));
    bounds.zMin = std::min(bounds.zMin, p.z);
    bounds.zMax = std::max(bounds.zMax, p.z);
  }
  return bounds;
}

// One unit of slack around the window where it has no extent, and where no receiver is in sight at all.
ReceiverBounds anythingAhead() {
  return {.window = {.lower = glm::dvec2(-1.0), .upper = glm::dvec2(1.0)}, .zMin = 1.0, .zMax = 2.0};
}

glsl::LightFrame toShared(const AxisFrame& frame) {
  return {.originW = glm::vec3(frame.originW),
          .rightW = glm::vec3(frame.worldFromLight[0]),
          .upW = glm::vec3(frame.worldFromLight[1]),
          .backW = glm::vec3(frame.worldFromLight[2])};
}

FittedMap fitPlanar(const FitInput& input, bool perspective) {
  const Bounds sceneBounds = computeBounds(input.scene);
  const double scale = std::max(static_cast<double>(sceneBounds.diagonal()), 1e-6);
  const glm::dvec3 origin = perspective ? input.light.positionW : glm::dvec3(sceneBounds.center());
  const AxisFrame frame = axisFrame(origin, input.light.directionW, perspective);
  const ReceiverBounds bounds = input.receiversW.empty() ? anythingAhead() : receiverBounds(input, frame);
  // Half a texel on every side keeps receivers on the very edge of the bounds inside.
  Window window = bounds.window;
  const glm::dvec2 pad =
      (window.upper - window.lower) * (0.5 / input.side) + 1e-6 * (perspective ? 1.0 : scale);
  window = snapWindow({.lower = window.lower - pad, .upper = window.upper + pad}, input.side);

  const double least = perspective ? kLeastNear * scale : -4.0 * scale;
  DepthRange range;
  range.zNear = nearestCasterDepth(input.scene, frame, window, least, bounds.zMax);
  range.zFar = bounds.zMax;
  const double slack = kRangeSlack * std::max(range.zFar - range.zNear, 1e-3 * scale);
  range.zNear = perspective ? range.zNear * (1.0 - kRangeSlack) : range.zNear - slack;
  range.zFar += slack;

  FittedMap fitted;
  fitted.frame = toShared(frame);
  fitted.positional = perspective;
  fitted.zNear = static_cast<float>(range.zNear);
  fitted.zFar = static_cast<float>(range.zFar);
  fitted.map = {};
  fitted.map.kind = glsl::kMapPlanar;
  fitted.map.layerCount = 1;
  fitted.map.side = fitted.map.rows = input.side;
  fitted.map.sceneScale = sceneBounds.diagonal();
  const glm::dmat4 clip = clipFromLight(window, range, perspective);
  fitted.map.mapLayers[0].clipFromLight = glm::mat4(clip);
  fitted.map.mapLayers[0].lightFromClip = glm::mat4(glm::inverse(clip));
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

  FittedMap fit(const FitInput& input) const override { return fitPlanar(input, true); }
};

class DirectionalParameterization final : public Parameterization {
 public:
  const char* name() const override { return "directional"; }
  const char* sentence() const override {
    return "one orthographic layer; a positional light becomes a sun from its side";
  }
  int layerCount(const MapOptions&) const override { return 1; }

  Takes takes(LightType type) const override {
    return type == LightType::Directional ? Takes::Yes : Takes::IfNothingElse;
  }

  LightModel lightModel(const Light& light, const glm::dvec3& aimW) const override {
    return {
        .type = LightType::Directional,
        .directionW = light.type == LightType::Point ? aimW : glm::normalize(glm::dvec3(light.directionW))};
  }

  FittedMap fit(const FitInput& input) const override { return fitPlanar(input, false); }
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
