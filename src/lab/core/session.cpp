#include "lab/core/session.h"

#include "base/check.h"
#include "base/error.h"
#include "scene/generate.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/gtx/component_wise.hpp>

#include <fmt/format.h>

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Where a light without a direction is made to shine: the mean direction of the surfaces in the picture that
// it lights (of all it faces, where it lights none). Directions and not points, so that what is near does not
// outweigh what is far.
glm::dvec3 aimOf(const Session& session, const Light& light) {
  const LightModel point{.type = LightType::Point, .positionW = glm::dvec3(light.positionW)};
  const Receivers receivers = computeReceivers(session.tracer(), session.view(), point, session.primitiveIds());
  const Truth truth = computeTruth(session.tracer(), point, receivers);
  glm::dvec3 sum(0.0);
  for (size_t i = 0; i < receivers.states.size(); ++i) {
    if (receivers.states[i] != PixelState::Scored || (truth.litCount > 0 && truth.lit[i] == 0)) continue;
    sum += glm::normalize(receivers.samples[i].positionW - point.positionW);
  }
  return glm::length(sum) > 0.0 ? glm::normalize(sum) : glm::dvec3(0, -1, 0);
}

}  // namespace

Session::Session(const gpu::DeviceOptions& deviceOptions, const SetupOptions& options)
    : setup_(options),
      scene_(std::make_shared<const Scene>(openScene(options.scene))),
      tracer_(std::make_shared<const Tracer>(*scene_)),
      device_(gpu::Device::create(deviceOptions)) {
  const PictureSize size = parseSize(options.size);
  camera_ = chooseCamera(options, *tracer_);
  buffers_ = std::make_shared<const SceneBuffers>(createSceneBuffers(*device_, *scene_));
  drawGBuffer(size.width, size.height);
}

Session::Session(const Session& other, const Camera& camera)
    : setup_(other.setup_),
      scene_(other.scene_),
      tracer_(other.tracer_),
      device_(other.device_),
      buffers_(other.buffers_),
      camera_(camera) {
  drawGBuffer(other.view().width, other.view().height);
}

void Session::drawGBuffer(int width, int height) {
  view_ = cameraView(camera_, width, height);
  gbuffer_ = std::make_unique<GBuffer>(*device_, width, height);
  timeGBuffer();
  ids_ = downloadPrimitiveIds(*device_, *gbuffer_, *buffers_);
}

double Session::timeGBuffer() const {
  gpu::Commands commands(*device_, "G-buffer");
  gbuffer_->record(commands, *buffers_, view_);
  return commands.submitAndWait().wallMs;
}

Exact traceExact(const Session& session, const Light& source, const LightModel& light) {
  Exact exact{.source = source, .light = light};
  exact.receivers = computeReceivers(session.tracer(), session.view(), light, session.primitiveIds());
  exact.truth = computeTruth(session.tracer(), light, exact.receivers);
  return exact;
}

Exact computeExact(const Session& session, const Parameterization& parameterization, const Light& source) {
  const glm::dvec3 aimW = source.type == LightType::Point ? aimOf(session, source) : glm::dvec3(0.0);
  return traceExact(session, source, parameterization.lightModel(source, aimW));
}

Exact computeExact(const Session& session, const Parameterization& parameterization) {
  const Light source = chooseLight(session.setup(), session.tracer(), parameterization);
  Exact exact = computeExact(session, parameterization, source);
  if (exact.receivers.scored == 0)
    throw WorldError(
        fmt::format("light '{}', camera '{}': the camera sees no surface that faces the light; move one of them "
                    "with --light or --camera",
                    source.name, session.camera().name));
  return exact;
}

Fit fitMap(const Session& session, const Parameterization& parameterization, const Exact& exact, int side,
           const MapOptions& options) {
  const Clock::time_point start = Clock::now();
  std::vector<glm::dvec3> scored;
  scored.reserve(exact.receivers.scored);
  for (size_t i = 0; i < exact.receivers.states.size(); ++i)
    if (exact.receivers.states[i] == PixelState::Scored) scored.push_back(exact.receivers.samples[i].positionW);
  Fit fit;
  fit.fitted = parameterization.fit({.scene = session.scene(),
                                     .light = exact.light,
                                     .receiversW = scored,
                                     .side = side,
                                     .camera = session.view(),
                                     .options = options});
  fit.ms = millisecondsSince(start);
  return fit;
}

DrawnMap drawMap(const Session& session, const Renderers& renderers, const FittedMap& fitted, const Exact& exact,
                 ChannelSet channels, CullMode cull) {
  DrawnMap map{.fitted = fitted};
  if (fitted.map.kind == glsl::kMapEpipolar) {
    GNOMON_CHECK_EQ(channels, glsl::kChannelDepth);
    map.volume = std::make_unique<ShadowVolume>(
        session.device(), FittedVolume{.grid = fitted.map.epipolar, .columns = fitted}, fitted.lookedUpIn);
  } else {
    map.image = std::make_unique<MapImage>(session.device(), fitted, channels);
  }
  redrawMap(session, renderers, map, exact, cull);
  return map;
}

double redrawMap(const Session& session, const Renderers& renderers, const DrawnMap& map, const Exact& exact,
                 CullMode cull) {
  gpu::Commands commands(session.device(), "shadow map");
  if (map.volume)
    renderers.volume.record(commands, renderers.map, session.buffers(), *map.volume, exact.light, cull);
  else
    renderers.map.record(commands, session.buffers(), *map.image, exact.light, cull);
  return commands.submitAndWait().wallMs;
}

namespace {

void recordVisibility(gpu::Commands& commands, const Session& session, Passes& passes, const DrawnMap& map,
                      const BiasMethod& bias, bool diagnose, const ChosenFilter& filter) {
  if (map.volume) {
    GNOMON_CHECK_EQ(filter.id, glsl::kShadowFilterNone);
    passes.volumeVisibility.record(commands, session.buffers(), session.gbuffer(), *map.volume, passes.visibility, bias,
                                   diagnose);
  } else {
    passes.visibility.record(commands, session.buffers(), session.gbuffer(), *map.image, bias, diagnose, filter);
  }
}

}  // namespace

double timeVisibility(const Session& session, Passes& passes, const DrawnMap& map, const Exact& exact,
                      const Method& method, const ChosenFilter& filter) {
  passes.visibility.setUniforms(shadeUniforms(session.view(), exact.light, method.params));
  gpu::Commands commands(session.device(), "visibility");
  recordVisibility(commands, session, passes, map, *method.bias, false, filter);
  return commands.submitAndWait().wallMs;
}

std::vector<float> filteredVisibility(const Session& session, Passes& passes, const DrawnMap& map, const Exact& exact,
                                      const Method& method, const ChosenFilter& filter) {
  timeVisibility(session, passes, map, exact, method, filter);
  return gpu::downloadAs<float>(session.device(), passes.visibility.visibility());
}

RayD texelRayW(const FittedMap& fitted, uint32_t texelWord) {
  const glm::vec2 uv = glsl::mapTexelCenter(fitted.map, glsl::unpackTexel(texelWord));
  const glsl::Ray ray = glsl::mapTexelRay(fitted.map, glsl::unpackLayer(texelWord), uv);
  const glm::dmat3 worldFromLight(glm::dvec3(fitted.frame.rightW), glm::dvec3(fitted.frame.upW),
                                  glm::dvec3(fitted.frame.backW));
  return {.origin = glm::dvec3(fitted.frame.originW) + worldFromLight * glm::dvec3(ray.origin),
          .dir = glm::normalize(worldFromLight * glm::dvec3(ray.dir))};
}

Verdict verdictOf(const glsl::PixelDiagnosis& pixel) {
  if ((pixel.flags & glsl::kPixelShaded) == 0) return Verdict::NotAsked;
  if ((pixel.flags & glsl::kPixelCovered) == 0) return Verdict::Uncovered;
  return (pixel.flags & glsl::kPixelLit) != 0 ? Verdict::Lit : Verdict::Shadow;
}

std::vector<glsl::PixelDiagnosis> diagnose(const Session& session, Passes& passes, const DrawnMap& map,
                                           const Exact& exact, const Method& method) {
  passes.visibility.setUniforms(shadeUniforms(session.view(), exact.light, method.params));
  gpu::Commands commands(session.device(), "visibility, diagnosed");
  recordVisibility(commands, session, passes, map, *method.bias, true, glsl::kShadowFilterNone);
  commands.submitAndWait();
  return gpu::downloadAs<glsl::PixelDiagnosis>(session.device(), passes.visibility.diagnosis());
}

Judged judge(const Session& session, Passes& passes, const DrawnMap& map, const Exact& exact, const Method& method) {
  const std::vector<glsl::PixelDiagnosis> diagnosis = diagnose(session, passes, map, exact, method);
  Judged judged;
  judged.visibility = gpu::downloadAs<float>(session.device(), passes.visibility.visibility());
  judged.verdicts.resize(diagnosis.size());
  for (size_t i = 0; i < diagnosis.size(); ++i) {
    judged.verdicts[i] = verdictOf(diagnosis[i]);
    if (exact.receivers.states[i] != PixelState::Scored) continue;
    if ((diagnosis[i].flags & glsl::kPixelGrazing) != 0) ++judged.grazing;
    if (judged.verdicts[i] == Verdict::NotAsked) {
      judged.edgeOn.push_back(i);
      judged.verdicts[i] = exact.truth.lit[i] != 0 ? Verdict::Lit : Verdict::Shadow;
    }
  }
  judged.labels = labelPixels(session.tracer(), exact.light, exact.receivers, exact.truth, judged.verdicts,
                              [&](size_t pixel) { return texelRayW(map.fitted, diagnosis[pixel].texel); });
  return judged;
}

double timeRadiance(const Session& session, Passes& passes) {
  gpu::Commands commands(session.device(), "radiance");
  passes.radiance.record(commands, session.buffers(), session.gbuffer(), passes.visibility.uniforms(),
                         passes.visibility.visibility());
  return commands.submitAndWait().wallMs;
}

ImageF renderRadiance(const Session& session, Passes& passes, const Exact& exact, std::span<const float> visibility) {
  // Exposure: a white surface that faces the light at the median distance of what is lit has radiance 0.75.
  std::vector<double> squaredDistances;
  for (size_t i = 0; i < exact.receivers.states.size(); i += 7) {
    if (exact.truth.lit[i] == 0 || exact.receivers.states[i] != PixelState::Scored) continue;
    const glm::dvec3 d = exact.receivers.samples[i].positionW - exact.light.positionW;
    squaredDistances.push_back(exact.light.type == LightType::Directional ? 1.0 : glm::dot(d, d));
  }
  double typical = 1.0;
  if (!squaredDistances.empty()) {
    const auto middle = squaredDistances.begin() + static_cast<std::ptrdiff_t>(squaredDistances.size() / 2);
    std::nth_element(squaredDistances.begin(), middle, squaredDistances.end());
    typical = *middle;
  }
  glsl::ShadeUniforms shade = shadeUniforms(session.view(), exact.light, {});
  const glm::vec3 color = exact.source.color / std::max(glm::compMax(exact.source.color), 1e-6f);
  shade.lightColor = color * static_cast<float>(0.75 * typical);
  shade.ambient = glm::vec3(0.07f, 0.08f, 0.10f);
  passes.visibility.setUniforms(shade);
  gpu::upload(session.device(), passes.visibility.visibility(), std::as_bytes(visibility));
  timeRadiance(session, passes);
  ImageF image(session.view().width, session.view().height, 3);
  image.values = gpu::downloadAs<float>(session.device(), passes.radiance.radiance());
  return image;
}

}  // namespace gnomon
