#include "omni/paraboloid_map.h"

#include "base/error.h"
#include "base/parse.h"
#include "omni/caster_range.h"
#include "planar/window.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

using Axis = std::optional<glm::dvec3>;

Axis parseAxis(const std::string& flag, const std::string& text) {
  if (text == "auto") return std::nullopt;
  const glm::vec3 axis = parseVec3(flag, text);
  if (axis == glm::vec3(0.0f)) throw UsageError(fmt::format("{} {} has no direction; write x,y,z or auto", flag, text));
  return glm::dvec3(axis);
}

// As few digits as tell it: what was typed is a float.
std::string axisText(const Axis& axis) {
  if (!axis) return "auto";
  const glm::vec3 rounded(*axis);
  return glm::dvec3(rounded) == *axis ? fmt::format("{},{},{}", rounded.x, rounded.y, rounded.z)
                                      : fmt::format("{},{},{}", axis->x, axis->y, axis->z);
}

std::string unitAxisText(const MapOptions& options) {
  const Axis& axis = options.get(kParaboloidAxisW);
  if (!axis) return "auto";
  const glm::dvec3 unit = glm::normalize(*axis);
  return fmt::format("{:.6g},{:.6g},{:.6g}", unit.x, unit.y, unit.z);
}

}  // namespace

constinit const WrittenOption<Axis> kParaboloidAxisW(
    {.name = "paraboloid_axis",
     .sentence = "x,y,z: axis of the first hemisphere; auto: chosen so that the seam is away from what the camera "
                 "sees",
     .told = unitAxisText},
    std::nullopt, parseAxis, axisText);

constinit const ChoiceOption<ParaboloidRaster> kParaboloidRaster(
    {.name = "paraboloid_raster", .sentence = "how triangles are drawn into a paraboloid"}, ParaboloidRaster::Exact,
    {{ParaboloidRaster::Vertex, "vertex", "straight edges between projected vertices, which is inexact"},
     {ParaboloidRaster::Tessellated, "tessellated",
      "like vertex, with triangles cut until the edges are right to half a texel"},
     {ParaboloidRaster::Exact, "exact", "one ray-triangle test a texel"}});

namespace {

// A hemisphere is drawn up to a circle of radius 1 + 6.5 / side on its plane (drawnRim), where what lies behind the
// light is less than this over the side of the distance.
constexpr float kRimTexels = 7.0f;

constexpr size_t kAxisCandidates = 1024;  // about 4.5 degrees apart
constexpr size_t kAxisReceivers = 1024;   // of the picture, evenly chosen
constexpr double kAxisPercentile = 0.05;

// Even over the hemisphere z > 0: equal steps of height, azimuths by the golden ratio.
glm::dvec3 candidateAxis(size_t i) {
  const double z = (static_cast<double>(i) + 0.5) / kAxisCandidates;
  const double azimuth = 2.0 * std::numbers::pi * std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

// The sine of the angle to the seam that all but a few receivers exceed.
double clearance(const glm::dvec3& axis, const std::vector<glm::dvec3>& directions) {
  std::vector<double> sines(directions.size());
  for (size_t i = 0; i < directions.size(); ++i) sines[i] = std::abs(glm::dot(axis, directions[i]));
  const auto low = sines.begin() + static_cast<std::ptrdiff_t>(kAxisPercentile * static_cast<double>(sines.size() - 1));
  std::nth_element(sines.begin(), low, sines.end());
  return *low;
}

SliceShaders shadersFor(ParaboloidRaster raster) {
  SliceShaders shaders;
  shaders.projective = false;
  if (raster == ParaboloidRaster::Exact) {
    shaders.vertex = "shadow/pull_bounded_triangle.vert.glsl";
    shaders.fragment = "omni/draw_in_paraboloid.frag.glsl";
    shaders.rasterizedDepth = false;
    shaders.bounds = "omni/bound_in_paraboloid.comp.glsl";
    shaders.largeBounds = "omni/bound_large_in_paraboloid.comp.glsl";
  } else if (raster == ParaboloidRaster::Tessellated) {
    shaders.vertex = "omni/pull_straight_triangle.vert.glsl";
    shaders.bounds = "omni/cut_for_paraboloid.comp.glsl";
  } else {
    shaders.vertex = "omni/project_to_paraboloid.vert.glsl";
    shaders.mirroredSlices = 0b10;
  }
  return shaders;
}

class ParaboloidParameterization final : public Parameterization {
 public:
  const char* name() const override { return "paraboloid"; }
  const char* sentence() const override { return "two hemispheres around a point light"; }
  int sliceCount(const MapOptions&) const override { return 2; }

  LightSupport supportsLight(LightType type) const override {
    return type == LightType::Directional ? LightSupport::No : LightSupport::Yes;
  }

  LightModel lightModel(const Light& light, const glm::dvec3&) const override {
    return {.type = LightType::Point, .positionW = glm::dvec3(light.positionW)};
  }

  FittedMap fit(const FitInput& input) const override {
    const glm::dvec3& lightW = input.light.positionW;
    const DepthEnds ends = chosenDepthEnds(input, Distance::Radial);
    const Axis& chosen = input.options.get(kParaboloidAxisW);
    const glm::dvec3 axisW = chosen ? glm::normalize(*chosen) : seamAvoidingAxis(lightW, input.receiversW);
    return makeParaboloidMap(lightW, axisW, input.options.get(kParaboloidRaster), ends.zNear, ends.zFar, input.side,
                             computeBounds(input.scene).diagonal());
  }

  std::vector<const MapOption*> options() const override {
    return {&kParaboloidRaster, &kParaboloidAxisW, &kDepthRange};
  }
  std::vector<Variant> variants(const MapOptions& given) const override {
    return {{"vertex", given.with(kParaboloidRaster(ParaboloidRaster::Vertex))},
            {"tessellated", given.with(kParaboloidRaster(ParaboloidRaster::Tessellated))}};
  }
  bool looksAround() const override { return true; }
};

}  // namespace

const Parameterization& paraboloidParameterization() {
  static const ParaboloidParameterization paraboloid;
  return paraboloid;
}

FittedMap makeParaboloidMap(const glm::dvec3& lightW, const glm::dvec3& axisW, ParaboloidRaster raster, double zNear,
                            double zFar, int side, float sceneScale) {
  const AxisFrame frame = axisFrame(lightW, axisW, true);
  FittedMap fitted;
  fitted.frame = {.originW = glm::vec3(lightW),
                  .rightW = glm::vec3(frame.worldFromLight[0]),
                  .upW = glm::vec3(frame.worldFromLight[1]),
                  .backW = glm::vec3(frame.worldFromLight[2])};
  fitted.zNear = static_cast<float>(zNear);
  fitted.zFar = static_cast<float>(zFar);
  fitted.map = {.kind = glsl::kMapParaboloid,
                .sliceCount = 2,
                .width = side,
                .height = side,
                .sceneScale = sceneScale,
                .zNear = fitted.zNear,
                .zFar = fitted.zFar};
  fitted.shaders = shadersFor(raster);
  for (int slice = 0; slice < 2; ++slice)
    fitted.halfSpaces.push_back(
        {.axisZ = glsl::paraboloidAxisZ(slice), .beyond = kRimTexels / static_cast<float>(side)});
  return fitted;
}

glm::dvec3 seamAvoidingAxis(const glm::dvec3& lightW, std::span<const glm::dvec3> receiversW) {
  const size_t stride = std::max<size_t>(receiversW.size() / kAxisReceivers, 1);
  std::vector<glm::dvec3> directions;
  for (size_t i = 0; i < receiversW.size(); i += stride)
    if (receiversW[i] != lightW) directions.push_back(glm::normalize(receiversW[i] - lightW));
  if (directions.empty()) return {0.0, -1.0, 0.0};
  std::vector<double> clearances(kAxisCandidates);
  tbb::parallel_for(size_t{0}, kAxisCandidates,
                    [&](size_t i) { clearances[i] = clearance(candidateAxis(i), directions); });
  const auto best = std::ranges::max_element(clearances);  // the first of equals
  const glm::dvec3 axis = candidateAxis(static_cast<size_t>(best - clearances.begin()));
  double side = 0.0;
  for (const glm::dvec3& direction : directions) side += glm::dot(axis, direction);
  return side >= 0.0 ? axis : -axis;
}

}  // namespace gnomon
