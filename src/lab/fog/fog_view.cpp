#include "lab/fog/fog_view.h"

#include "base/check.h"
#include "base/error.h"
#include "truth/scattering.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <tbb/parallel_for.h>

namespace gnomon {

namespace {

constexpr double kExposedPercentile = 0.99;
constexpr float kExposedTo = 0.9f;

// Of rays through a density between surfaces and the eye or a light.
constexpr double kStepVoxels = 0.5;

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

// What the light of each pixel's surface passes through on its way, to the metre of density 1.
template <typename Path>
std::vector<double> pathsOf(const GroundTruth& exact, const Path& path) {
  std::vector<double> paths(exact.receivers.states.size(), 0.0);
  tbb::parallel_for(size_t{0}, paths.size(), [&](size_t i) {
    if (exact.receivers.states[i] != PixelState::Empty) paths[i] = path(i);
  });
  return paths;
}

double opticalMetres(const MediumModel& medium, const glm::dvec3& fromW, const glm::dvec3& toW) {
  if (medium.density == nullptr) return glm::length(toW - fromW);
  return densityBetween(*medium.density, fromW, toW, kStepVoxels * medium.density->voxelMetres());
}

// The surfaces' own light, dimmed by what it passes through.
void addSurfaces(const SceneView& scene, ShadowPasses& passes, const GroundTruth& exact,
                 const glsl::ShadeUniforms& shade, const MediumModel& medium, const std::vector<double>& paths,
                 ImageF& surface) {
  const std::vector<float> visibility(exact.truth.lit.begin(), exact.truth.lit.end());
  const ImageF radiance = passes.shade(scene, shade, visibility);
  const glm::dvec3 sigmaT = medium.sigmaS + medium.sigmaA;
  for (size_t i = 0; i < paths.size(); ++i) {
    const glm::vec3 pixel(radiance.values[3 * i], radiance.values[3 * i + 1], radiance.values[3 * i + 2]);
    const glm::dvec3 dimmed = glm::dvec3(pixel) * glm::exp(-sigmaT * paths[i]);
    for (int c = 0; c < 3; ++c) surface.values[3 * i + static_cast<size_t>(c)] += static_cast<float>(dimmed[c]);
  }
}

// With the exact shadow, so that pictures differ by their medium alone.
ImageF surfaceSlice(const SceneView& scene, ShadowPasses& passes, const FogView& view, float ambient,
                    const std::vector<GroundTruth>& exacts) {
  ImageF surface(scene.view().width, scene.view().height, 3);
  const glm::dvec3 eyeW(scene.view().eyeW);
  const std::vector<double> towardsEye = pathsOf(exacts.front(), [&](size_t i) {
    const glm::dvec3 towards = exacts.front().receivers.samples[i].positionW - eyeW;
    const double distance = glm::length(towards);  // the medium ends at its reach, what stands behind is seen
    return opticalMetres(view.model, eyeW, eyeW + towards * std::min(view.model.reach / distance, 1.0));
  });
  for (size_t l = 0; l < exacts.size(); ++l) {
    const GroundTruth& exact = exacts[l];
    const std::vector<double> bothLegs = pathsOf(exact, [&](size_t i) {
      const glm::dvec3& posW = exact.receivers.samples[i].positionW;
      return towardsEye[i] + (exact.truth.lit[i] != 0 ? opticalMetres(view.model, exact.light.positionW, posW) : 0.0);
    });
    glsl::ShadeUniforms shade = shadeUniforms(scene.view(), exact.light, {});
    shade.lightColor = view.sources[l].intensity * static_cast<float>(1.0 / std::numbers::pi);  // albedo / pi
    shade.ambient = glm::vec3(0.0f);
    addSurfaces(scene, passes, exact, shade, view.model, bothLegs, surface);
  }
  if (ambient > 0.0f) {
    glsl::ShadeUniforms shade = shadeUniforms(scene.view(), exacts.front().light, {});
    shade.lightColor = glm::vec3(0.0f);
    shade.ambient = glm::vec3(ambient);
    addSurfaces(scene, passes, exacts.front(), shade, view.model, towardsEye, surface);
  }
  return surface;
}

// The medium's own complaint, as one of the flag.
void checkHasPosition(const Light& light) {
  try {
    mediaLight(light);
  } catch (const WorldError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace

std::vector<Light> fogLights(const Session& session) {
  for (const Light& light : session.scene().lights)
    if (light.name == session.setup().light) checkHasPosition(light);
  return chooseLights(session.setup(), session.tracer(), volumeParameterization());
}

FogView lookIntoFog(const SceneView& scene, ShadowPasses& passes, const std::vector<Light>& lights,
                    const FogMedium& medium) {
  FogView view{.lights = lights};
  double diagonal = static_cast<double>(computeBounds(scene.scene()).diagonal());
  if (medium.density) {
    diagonal = std::min(diagonal, static_cast<double>(medium.density->boundsW().diagonal()));
    view.density = medium.density;
    view.densityBuffers = std::make_shared<const DensityBuffers>(createDensityBuffers(scene.device(), *medium.density));
  }
  const glm::vec3 grey(static_cast<float>(kDefaultOpticalDepth / std::max(diagonal, 1e-6)));
  view.medium = {.sigmaS = medium.sigmaS.value_or(grey), .sigmaA = medium.sigmaA, .g = medium.g};
  view.medium.reach = medium.reach ? static_cast<float>(*medium.reach) : defaultReach(scene.scene(), scene.view().eyeW);
  view.model = {.sigmaS = glm::dvec3(view.medium.sigmaS),
                .sigmaA = glm::dvec3(view.medium.sigmaA),
                .g = static_cast<double>(view.medium.g),
                .reach = static_cast<double>(view.medium.reach),
                .density = view.density.get()};
  std::vector<GroundTruth> exacts;
  for (const Light& light : lights) {
    view.sources.push_back(mediaLight(light));
    view.exactLights.push_back(exactLight(view.sources.back()));
    exacts.push_back(traceGroundTruth(scene, light, modelOf(light)));
    if (view.exactLights.back().positionW == glm::dvec3(scene.view().eyeW))
      throw WorldError(
          fmt::format("the light '{}' stands at the camera's eye, where its scattered light is "
                      "infinite; move one of them with --light or --camera",
                      light.name));
  }
  const Receivers& receivers = exacts.front().receivers;  // where they are does not depend on the light
  view.ends = viewRayEnds(scene.view(), receivers, view.model.reach);
  view.receiversW = mediaReceiversW(scene.view(), receivers, view.model.reach);
  view.surface = surfaceSlice(scene, passes, view, medium.ambient, exacts);
  return view;
}

FogExposure exposureFor(const FogView& view, const ImageF& inScattered) {
  return mediumExposureFor(composed(view, inScattered));
}

FogExposure mediumExposureFor(const ImageF& radiance) {
  std::vector<float> largest(radiance.values.size() / 3);
  for (size_t i = 0; i < largest.size(); ++i)
    largest[i] = std::max({radiance.values[3 * i], radiance.values[3 * i + 1], radiance.values[3 * i + 2]});
  const auto at =
      largest.begin() + static_cast<std::ptrdiff_t>(kExposedPercentile * static_cast<double>(largest.size() - 1));
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
