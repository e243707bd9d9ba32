#include "lab/fog_view.h"

#include "base/check.h"
#include "base/error.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr double kExposedPercentile = 0.99;
constexpr float kExposedTo = 0.9f;

LightModel modelOf(const Light& light) {
  LightModel model{.type = light.type, .positionW = glm::dvec3(light.positionW)};
  if (light.type == LightType::Spot) {
    model.directionW = glm::normalize(glm::dvec3(light.directionW));
    model.outerConeRad = light.outerConeRad;
  }
  return model;
}

MediaLight exactLight(const MediaLightSource& source) {
  return {.positionW = source.positionW,
          .intensity = glm::dvec3(source.intensity),
          .axisW = source.coneAxisW,
          .cosCone = source.coneCos};
}

// With the exact shadow, so that pictures differ by their medium alone.
ImageF surfaceLayer(const Session& session, Passes& passes, const FogView& view, float ambient,
                    const std::vector<Exact>& exacts) {
  MediaPass pass(session.device(), session.view().width, session.view().height);
  pass.setMedium(session.view(), view.medium);
  for (size_t i = 0; i < exacts.size(); ++i) {
    std::vector<float> visibility(exacts[i].truth.lit.begin(), exacts[i].truth.lit.end());
    glsl::ShadeUniforms shade = shadeUniforms(session.view(), exacts[i].light, {});
    // A diffuse surface reflects albedo / pi.
    shade.lightColor = view.sources[i].intensity * static_cast<float>(1.0 / std::numbers::pi);
    shade.ambient = glm::vec3(i == 0 ? ambient : 0.0f);
    passes.visibility.setUniforms(shade);
    gpu::upload(session.device(), passes.visibility.visibility(), std::as_bytes(std::span(visibility)));
    gpu::Commands commands(session.device(), "surfaces in a medium");
    pass.recordSurfaces(commands, session.buffers(), session.gbuffer(), passes.visibility.uniforms(),
                        passes.visibility.visibility(), i > 0);
    commands.submitAndWait();
  }
  ImageF surface(session.view().width, session.view().height, 3);
  surface.values = gpu::downloadAs<float>(session.device(), pass.surfaces());
  return surface;
}

}  // namespace

std::vector<Light> fogLights(const Session& session) {
  for (const Light& light : session.scene().lights)
    if (light.name == session.setup().light) mediaLight(light);  // says so where it has no position
  return chooseLights(session.setup(), session.tracer(), volumeParameterization());
}

FogView lookIntoFog(const Session& session, Passes& passes, const std::vector<Light>& lights,
                    const FogMedium& medium) {
  FogView view{.lights = lights};
  const double diagonal = static_cast<double>(computeBounds(session.scene()).diagonal());
  const glm::vec3 grey(static_cast<float>(kDefaultOpticalDepth / std::max(diagonal, 1e-6)));
  view.medium = {.sigmaS = medium.sigmaS.value_or(grey), .sigmaA = medium.sigmaA, .g = medium.g};
  view.medium.reach =
      medium.reach ? static_cast<float>(*medium.reach) : defaultReach(session.scene(), session.view().eyeW);
  view.model = {.sigmaS = glm::dvec3(view.medium.sigmaS),
                .sigmaA = glm::dvec3(view.medium.sigmaA),
                .g = static_cast<double>(view.medium.g),
                .reach = static_cast<double>(view.medium.reach)};
  std::vector<Exact> exacts;
  for (const Light& light : lights) {
    view.sources.push_back(mediaLight(light));
    view.exactLights.push_back(exactLight(view.sources.back()));
    exacts.push_back(traceExact(session, light, modelOf(light)));
    if (view.exactLights.back().positionW == glm::dvec3(session.view().eyeW))
      throw WorldError(
          fmt::format("the light '{}' stands at the camera's eye, where its scattered light is "
                      "infinite; move one of them with --light or --camera",
                      light.name));
  }
  const Receivers& receivers = exacts.front().receivers;  // where they are does not depend on the light
  view.ends = viewRayEnds(session.view(), receivers, view.model.reach);
  view.receiversW = mediaReceiversW(session.view(), receivers, view.model.reach);
  view.surface = surfaceLayer(session, passes, view, medium.ambient, exacts);
  return view;
}

FogExposure exposureFor(const FogView& view, const ImageF& inScattered) {
  return mediumExposureFor(composed(view, inScattered));
}

FogExposure mediumExposureFor(const ImageF& radiance) {
  std::vector<float> largest(radiance.values.size() / 3);
  for (size_t i = 0; i < largest.size(); ++i)
    largest[i] = std::max({radiance.values[3 * i], radiance.values[3 * i + 1], radiance.values[3 * i + 2]});
  const auto at = largest.begin() +
                  static_cast<std::ptrdiff_t>(kExposedPercentile * static_cast<double>(largest.size() - 1));
  std::ranges::nth_element(largest, at);
  return {*at > 0.0f ? kExposedTo / *at : 1.0f};
}

ImageF composed(const FogView& view, const ImageF& inScattered) {
  GNOMON_CHECK_EQ(view.surface.values.size(), inScattered.values.size());
  ImageF radiance = view.surface;
  for (size_t i = 0; i < radiance.values.size(); ++i) radiance.values[i] += inScattered.values[i];
  return radiance;
}

Image8 exposed(const ImageF& radiance, const FogExposure& exposure) {
  ImageF scaled = radiance;
  for (float& value : scaled.values) value *= exposure.factor;
  return toSrgb8(scaled);
}

}  // namespace gnomon
