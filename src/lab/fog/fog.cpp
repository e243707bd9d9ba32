#include "lab/fog/fog.h"

#include "base/interrupt.h"
#include "base/progress.h"
#include "lab/fog/fog_motion.h"
#include "lab/fog/fog_pictures.h"
#include "lab/fog/fog_reference.h"
#include "lab/picture/flip.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

// In a density every integrator marches, and those that read the same differ in nothing.
std::vector<MediaMethod> methodsOf(const FogOptions& options) {
  std::vector<MediaMethod> methods;
  const bool dense = options.medium.density != nullptr;
  for (const Integrator* chosen : options.integrators) {
    const Integrator* integrator = dense ? &integratorInDensity(*chosen) : chosen;
    for (const int steps : dense || integrator->takesSteps ? options.steps : std::vector{0}) {
      const MediaMethod method{.integrator = integrator, .steps = steps};
      if (std::ranges::find(methods, method) == methods.end()) methods.push_back(method);
    }
  }
  return methods;
}

Params paramsOf(const MediaMethod& method, const FogOptions& options, size_t lightCount) {
  const bool ofMap = method.readsDepths();
  Params params = {{"map_size", ofMap ? std::to_string(options.mapSide) : options.map.text(kVolumeSize)},
                   {"lights", static_cast<int64_t>(lightCount)}};
  if (!ofMap) {
    params.push_back({"vsv_source", options.map.text(kVolumeSource)});
    params.push_back({"vsv_fit", options.map.text(kVolumeFit)});
    if (options.map.get(kVolumeSource) == VolumeSource::Resample)
      params.push_back({"cube_size", int64_t{options.mapSide}});
  }
  params.push_back({"cull", cullModeName(options.cull)});
  return params;
}

MediaRow rowOf(const MediaMethod& method, const FogMethodResult& measured, const FogOptions& options,
               size_t lightCount) {
  return {.integrator = method.integrator->name,
          .steps = method.steps > 0 ? std::optional(method.steps) : std::nullopt,
          .isBaseline = method.integrator->isBaseline,
          .map = method.readsDepths() ? options.marchMap->name() : volumeParameterization().name(),
          .params = paramsOf(method, options, lightCount),
          .mapMs = measured.mapMs,
          .tableMs = measured.tableMs,
          .integrateMs = measured.integrateMs};
}

void judgeRows(FogResult& result) {
  const ImageF& reference = result.reference->inScattered;
  const Image8 exact = exposed(composed(result.view, reference), result.exposure);
  for (size_t i = 0; i < result.rows.size(); ++i) {
    result.rows[i].relRmse = relativeRmse(result.inScattered[i], reference);
    result.rows[i].relRmse99 = relativeRmse(result.inScattered[i], reference, 0.99);
    result.rows[i].flip =
        computeFlip(exact, exposed(composed(result.view, result.inScattered[i]), result.exposure)).mean;
  }
  result.worst = worstMediaPlace(result.inScattered.front(), reference);
  result.equalTerms = equalTerms(result.rows);
}

void writePictures(const FogOptions& options, FogResult& result) {
  const ImageF* reference = result.reference ? &result.reference->inScattered : nullptr;
  for (size_t i = 0; i < result.rows.size(); ++i) {
    std::string stem = "media/" + result.rows[i].name();
    std::ranges::replace(stem, ' ', '_');
    result.rows[i].pictures = writeMediaRowPictures(result.view, result.inScattered[i], reference, result.worst,
                                                    {result.exposure, result.mediumExposure}, stem, options.outDir);
  }
  if (reference == nullptr) return;
  result.pictures = writeMediaRowPictures(result.view, *reference, nullptr, std::nullopt,
                                          {result.exposure, result.mediumExposure}, "media/reference", options.outDir);
}

}  // namespace

FogResult runFog(const Session& session, const FogOptions& options) {
  FogResult result;
  ShadowPasses passes(session);
  {
    Progress progress("fog", 2);
    progress.step("surfaces");
    result.view = lookIntoFog(session, passes, fogLights(session), options.medium);
    std::vector<double> gbufferMs;
    for (int i = 0; i < std::max(options.repeats, 1); ++i) gbufferMs.push_back(session.timeGBuffer());
    result.gbufferMs = median(gbufferMs);

    progress.step("integrating");
    const FogMethodOptions how{.methods = methodsOf(options),
                               .marchMap = options.marchMap,
                               .map = options.map,
                               .mapSide = options.mapSide,
                               .cull = options.cull,
                               .repeats = options.repeats};
    const std::vector<FogMethodResult> measured = runFogMethods(session, passes, result.view, how);
    result.methods = how.methods;
    for (size_t i = 0; i < measured.size(); ++i) {
      result.rows.push_back(rowOf(how.methods[i], measured[i], options, result.view.lights.size()));
      result.inScattered.push_back(measured[i].inScattered);
    }
  }
  try {
    if (options.truth) {
      KeptReference kept = referenceFor(session, result.view, options.reference, options.cache);
      result.reference = std::move(kept.reference);
      result.referenceFromCache = kept.fromCache;
    }
  } catch (const Interrupted&) {  // pictures without a reference
  }
  const ImageF& best = result.reference ? result.reference->inScattered : result.inScattered.front();
  result.exposure = options.exposure ? FogExposure{*options.exposure} : exposureFor(result.view, best);
  result.mediumExposure = options.exposure ? FogExposure{*options.exposure} : mediumExposureFor(best);
  if (result.reference) judgeRows(result);
  if (options.motion) runMotion(session, passes, options, result);
  if (!options.outDir.empty()) writePictures(options, result);
  result.isComplete = !isInterrupted();
  return result;
}

}  // namespace gnomon
