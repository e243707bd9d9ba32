#include "judge/light_on_map.h"

#include "base/check.h"
#include "base/error.h"
#include "judge/filtered_truth.h"
#include "judge/texel_density.h"
#include "judge/unseen_occluders.h"
#include "shadow/occluders.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <numbers>

#include <fmt/format.h>

#include <glm/gtx/component_wise.hpp>

namespace gnomon {

namespace {

const Light& requireLightFor(const Scene& scene, const Parameterization& map) {
  const Light* light = firstLightFor(scene, map);
  if (light == nullptr)
    throw WorldError(fmt::format("scene '{}' has no light that a {} map can be made of", scene.name, map.name()));
  return *light;
}

std::vector<glm::dvec3> scoredPoints(const Receivers& receivers) {
  std::vector<glm::dvec3> points;
  points.reserve(receivers.scored);
  for (size_t i = 0; i < receivers.states.size(); ++i)
    if (receivers.states[i] == PixelState::Scored) points.push_back(receivers.samples[i].positionW);
  return points;
}

void addWalks(WalkCounts& counts, const glsl::PixelDiagnosis& pixel) {
  const uint32_t aborted = pixel.walkSteps >> 20;
  for (int end = 0; end < glsl::kWalkAborted; ++end) counts.ends[end] += pixel.walkEnds >> (5 * end) & 31u;
  for (int end = 0; end < glsl::kWalkAborted; ++end) counts.walks += pixel.walkEnds >> (5 * end) & 31u;
  counts.ends[glsl::kWalkAborted] += aborted;
  counts.walks += aborted;
  counts.steps += pixel.walkSteps & 4095u;
  counts.longest = std::max(counts.longest, pixel.walkSteps >> 12 & 255u);
}

}  // namespace

bool Method::operator==(const Method& other) const {
  return bias == other.bias && std::memcmp(&params, &other.params, sizeof params) == 0;
}

Method atDefaults(const BiasMethod& bias, const SceneView& view) {
  return {.bias = &bias, .params = defaultBiasParams(bias, view.sceneScale())};
}

Verdict verdictOf(const glsl::PixelDiagnosis& pixel) {
  if ((pixel.flags & glsl::kPixelShaded) == 0) return Verdict::NotAsked;
  if ((pixel.flags & glsl::kPixelCovered) == 0) return Verdict::Uncovered;
  return (pixel.flags & glsl::kPixelLit) != 0 ? Verdict::Lit : Verdict::Shadow;
}

float visibilityOf(const glsl::PixelDiagnosis& pixel, bool empty) {
  if ((pixel.flags & glsl::kPixelShaded) == 0) return empty ? 1.0f : 0.0f;
  if ((pixel.flags & glsl::kPixelUnknown) != 0) return glsl::kUnknownVisibility;
  const uint32_t lit = glsl::kPixelCovered | glsl::kPixelLit;
  return (pixel.flags & lit) == glsl::kPixelCovered ? 0.0f : 1.0f;
}

RayD texelRayW(const FittedMap& fitted, uint32_t texelWord) {
  const glm::vec2 uv = glsl::mapTexelCenter(fitted.map, glsl::unpackTexel(texelWord));
  const glsl::Ray ray = glsl::mapTexelRay(fitted.map, glsl::unpackSlice(texelWord), uv);
  const glm::dmat3 worldFromLight(glm::dvec3(fitted.frame.rightW), glm::dvec3(fitted.frame.upW),
                                  glm::dvec3(fitted.frame.backW));
  return {.origin = glm::dvec3(fitted.frame.originW) + worldFromLight * glm::dvec3(ray.origin),
          .dir = glm::normalize(worldFromLight * glm::dvec3(ray.dir))};
}

LightOnMap::LightOnMap(const SceneView& view, ShadowPasses& passes, const Parameterization& map, const Light& source,
                       const LightModel& light, MapSetup setup)
    : view_(view), passes_(passes), map_(map), setup_(std::move(setup)), source_(source), light_(light) {}

LightOnMap::LightOnMap(const SceneView& view, ShadowPasses& passes, const Parameterization& map, const Light& source,
                       MapSetup setup)
    : LightOnMap(view, passes, map, source, lightTakenBy(map, view, source), std::move(setup)) {}

LightOnMap::LightOnMap(const SceneView& view, ShadowPasses& passes, const Parameterization& map, MapSetup setup)
    : LightOnMap(view, passes, map, requireLightFor(view.scene(), map), std::move(setup)) {}

LightOnMap::LightOnMap(const LightOnMap& other, MapSetup setup)
    : LightOnMap(other.view_, other.passes_, other.map_, other.source_, other.light_, std::move(setup)) {
  other.groundTruth();
  truth_ = other.truth_;
}

void LightOnMap::takeRoomOf(LightOnMap& other) {
  if (&map_ != &other.map_) return;
  room_ = std::move(other.occluders_);
  room_.merge(other.room_);
}

void LightOnMap::takeMapOf(LightOnMap& other) {
  GNOMON_CHECK(&map_ == &other.map_ && light_ == other.light_);
  fit_ = std::exchange(other.fit_, std::nullopt);
  occluders_ = std::move(other.occluders_);
}

const GroundTruth& LightOnMap::groundTruth() const {
  if (!truth_) truth_ = view_.groundTruths().of(view_, source_, light_);
  return *truth_;
}

const LightOnMap::Fit& LightOnMap::fit() const {
  if (fit_) return *fit_;
  if (!setup_.receiversW) groundTruth();  // not a part of what fitting takes
  const auto start = std::chrono::steady_clock::now();
  const std::vector<glm::dvec3> receiversW = setup_.receiversW ? *setup_.receiversW : scoredPoints(receivers());
  Fit made{.fitted = map_.fit({.scene = view_.scene(),
                               .light = light_,
                               .receiversW = receiversW,
                               .side = setup_.side,
                               .camera = view_.view(),
                               .options = setup_.options})};
  made.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return fit_.emplace(std::move(made));
}

const FittedMap& LightOnMap::fitted() const {
  return fit().fitted;
}

double LightOnMap::fitMs() const {
  return fit().ms;
}

const Occluders& LightOnMap::occluders(ChannelSet channels) {
  const auto found = occluders_.find(channels);
  if (found != occluders_.end()) return *found->second;
  const auto room = room_.find(channels);
  if (room != room_.end() && room->second->hasFormOf(fitted())) {
    gpu::Commands commands(view_.device(), "map's numbers");
    room->second->recordFit(commands, fitted());
    commands.submitAndWait();
    occluders_.insert(room_.extract(room));
  } else {
    occluders_.emplace(channels, map_.createOccluders(view_.device(), fitted(), channels));
  }
  try {
    redraw(channels);
  } catch (...) {  // what is not drawn is nobody's
    occluders_.erase(channels);
    throw;
  }
  return *occluders_.at(channels);
}

double LightOnMap::redraw(ChannelSet channels) {
  occluders(channels);
  gpu::Commands commands(view_.device(), "shadow map");
  occluders_.at(channels)->recordDrawing(commands, passes_.maps, view_.buffers(), light_, setup_.cull);
  return commands.submitAndWait().wallMs;
}

double LightOnMap::timeLookup(const Method& method, const ShadowLookup& lookup) {
  const Occluders& drawn = occluders(method.bias->channels);
  passes_.visibility.setUniforms(shadeUniforms(view_.view(), light_, method.params));
  gpu::Commands commands(view_.device(), lookup.diagnose ? "visibility, diagnosed" : "visibility");
  drawn.recordVisibility(commands, view_.buffers(), view_.gbuffer(), passes_.visibility, lookup);
  return commands.submitAndWait().wallMs;
}

void LightOnMap::warmUp(const Method& method, const ChosenFilter& filter) {
  timeLookup(method, {.bias = *method.bias, .filter = filter, .oneGroup = true});
}

double LightOnMap::timeVisibility(const Method& method, const ChosenFilter& filter) {
  return timeLookup(method, {.bias = *method.bias, .filter = filter});
}

std::vector<float> LightOnMap::visibility(const Method& method, const ChosenFilter& filter) {
  timeVisibility(method, filter);
  return gpu::downloadAs<float>(view_.device(), passes_.visibility.visibility());
}

void LightOnMap::expect(std::vector<Method> methods) {
  expected_ = std::move(methods);
  decided_.clear();
}

std::optional<std::vector<glsl::PixelDiagnosis>> LightOnMap::diagnoseTogether(const Method& method) {
  const auto indexIn = [&](const std::vector<Method>& methods) {
    return static_cast<size_t>(std::ranges::find(methods, method) - methods.begin());
  };
  const ChannelSet channels = method.bias->channels;
  if (const auto known = decided_.find(channels); known != decided_.end()) {
    const size_t slot = indexIn(known->second.methods);
    if (slot < known->second.methods.size()) return known->second.decisions.of(slot);
  }
  std::vector<Method> group;
  std::vector<const BiasMethod*> biases;
  for (size_t i = indexIn(expected_); i < expected_.size(); ++i) {
    if (!decidedTogether(*method.bias, *expected_[i].bias)) continue;
    group.push_back(expected_[i]);
    biases.push_back(expected_[i].bias);
  }
  if (group.size() < 2) return std::nullopt;
  group.resize(passes_.decisions.mostOf(biases));
  biases.resize(group.size());
  std::vector<glsl::BiasParams> params;
  for (const Method& one : group) params.push_back(one.params);
  const Occluders& drawn = occluders(channels);
  gpu::Commands commands(view_.device(), "decisions");
  if (!drawn.recordDecisions(commands, view_.buffers(), view_.gbuffer(), passes_.decisions, biases, params,
                             shadeUniforms(view_.view(), light_, {})))
    return std::nullopt;
  commands.submitAndWait();
  const Decided made{std::move(group), passes_.decisions.download(biases)};
  return decided_.insert_or_assign(channels, made).first->second.decisions.of(0);
}

std::vector<glsl::PixelDiagnosis> LightOnMap::diagnose(const Method& method) {
  if (auto diagnosis = diagnoseTogether(method)) return std::move(*diagnosis);
  timeLookup(method, {.bias = *method.bias, .diagnose = true});
  return gpu::downloadAs<glsl::PixelDiagnosis>(view_.device(), passes_.visibility.diagnosis());
}

LabelledResult LightOnMap::judge(const Method& method) {
  const std::vector<glsl::PixelDiagnosis> diagnosis = diagnose(method);
  LabelledResult result;
  result.visibility.resize(diagnosis.size());
  result.verdicts.resize(diagnosis.size());
  const std::span<const glsl::PrimitiveId> seen = view_.primitiveIds();
  for (size_t i = 0; i < diagnosis.size(); ++i) {
    result.visibility[i] = visibilityOf(diagnosis[i], seen[i].instancePlusOne == 0);
    result.verdicts[i] = verdictOf(diagnosis[i]);
    if (receivers().states[i] != PixelState::Scored) continue;
    if ((diagnosis[i].flags & glsl::kPixelGrazing) != 0) ++result.grazing;
    addWalks(result.walks, diagnosis[i]);
    if (result.verdicts[i] == Verdict::NotAsked) {
      result.edgeOn.push_back(i);
      result.verdicts[i] = truth().lit[i] != 0 ? Verdict::Lit : Verdict::Shadow;
    }
  }
  const FittedMap& map = fitted();
  result.labels = labelPixels(view_.tracer(), light_, receivers(), truth(), result.verdicts,
                              [&](size_t pixel) { return texelRayW(map, diagnosis[pixel].texel); });
  const ChannelSet channels = method.bias->channels;
  if ((channels & glsl::kChannelIds) != 0) {
    const std::vector<uint32_t> ids = occluders(channels).downloadIds(view_.device());
    findUnseenOccluders(result.labels, view_, light_, receivers(), truth(),
                        {.fitted = map, .ids = ids, .reach = method.params.witnessReach});
  }
  return result;
}

std::vector<float> LightOnMap::filteredTruth(const ChosenFilter& filter) const {
  return computeFilteredTruth(view_.tracer(), light_, receivers(), truth(), fitted(), filter);
}

std::vector<float> LightOnMap::texelDensities() const {
  return gnomon::texelDensities(fitted(), receivers());
}

double LightOnMap::exposureFactor() const {
  if (setup_.exposure) return static_cast<double>(*setup_.exposure);
  const double intensity = static_cast<double>(glm::compMax(source_.color) * source_.intensity);
  return static_cast<double>(glm::compMax(exposure().lightColor)) * std::numbers::pi / std::max(intensity, 1e-30);
}

Exposure LightOnMap::exposure() const {
  const glm::vec3 ambient(0.07f, 0.08f, 0.10f);
  if (setup_.exposure)
    return {.lightColor = source_.color * (source_.intensity * *setup_.exposure / std::numbers::pi_v<float>),
            .ambient = ambient};
  const Receivers& seen = receivers();
  std::vector<double> squaredDistances;
  for (size_t i = 0; i < seen.states.size(); i += 7) {
    if (truth().lit[i] == 0 || seen.states[i] != PixelState::Scored) continue;
    const glm::dvec3 d = seen.samples[i].positionW - light_.positionW;
    squaredDistances.push_back(light_.type == LightType::Directional ? 1.0 : glm::dot(d, d));
  }
  double typical = 1.0;
  if (!squaredDistances.empty()) {
    const auto middle = squaredDistances.begin() + static_cast<std::ptrdiff_t>(squaredDistances.size() / 2);
    std::nth_element(squaredDistances.begin(), middle, squaredDistances.end());
    typical = *middle;
  }
  const glm::vec3 color = source_.color / std::max(glm::compMax(source_.color), 1e-6f);
  return {.lightColor = color * static_cast<float>(0.75 * typical), .ambient = ambient};
}

glsl::ShadeUniforms LightOnMap::exposedUniforms(const Exposure& exposure, const glsl::BiasParams& params) const {
  glsl::ShadeUniforms shade = shadeUniforms(view_.view(), light_, params);
  shade.lightColor = exposure.lightColor;
  shade.ambient = exposure.ambient;
  return shade;
}

ImageF LightOnMap::radiance(std::span<const float> visibility, const Exposure& exposure) const {
  return passes_.shade(view_, exposedUniforms(exposure, {}), visibility);
}

ImageF LightOnMap::picture(const Method& method, const ChosenFilter& filter) {
  const Occluders& drawn = occluders(method.bias->channels);
  gpu::Commands commands(view_.device(), "frame");
  const bool inOnePass =
      drawn.recordFrame(commands, view_.buffers(), passes_.frame, {.bias = *method.bias, .filter = filter},
                        exposedUniforms(exposure(), method.params));
  if (!inOnePass) {
    timeLookup(method, {.bias = *method.bias, .filter = filter, .once = true});
    return radiance(gpu::downloadAs<float>(view_.device(), passes_.visibility.visibility()));
  }
  commands.submitAndWait();
  const auto colors = gpu::downloadAs<glm::vec4>(view_.device(), passes_.frame.radiance());
  ImageF image(view_.view().width, view_.view().height, 3);
  for (size_t i = 0; i < colors.size(); ++i)
    for (int channel = 0; channel < 3; ++channel)
      image.values[3 * i + static_cast<size_t>(channel)] = colors[i][channel];
  return image;
}

double LightOnMap::timeFrame(const Method& method, const ChosenFilter& filter, bool redrawn) {
  occluders(method.bias->channels);
  Occluders& drawn = *occluders_.at(method.bias->channels);
  const glsl::ShadeUniforms shade = exposedUniforms(exposure(), method.params);
  gpu::Commands commands(view_.device(), "frame");
  if (redrawn) {
    drawn.recordDrawing(commands, passes_.maps, view_.buffers(), light_, setup_.cull);
    commands.barrier("the map is drawn -> the frame looks it up");
  }
  GNOMON_CHECK(
      drawn.recordFrame(commands, view_.buffers(), passes_.frame, {.bias = *method.bias, .filter = filter}, shade));
  return commands.submitAndWait().wallMs;
}

}  // namespace gnomon
