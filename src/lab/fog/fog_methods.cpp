#include "lab/fog/fog_methods.h"

#include "lab/core/method.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>

namespace gnomon {

namespace {

// One light's volume and map, fitted to all view rays and drawn for the methods that read them.
class LightMaps {
 public:
  LightMaps(const SceneView& scene, ShadowPasses& passes, const FogView& view, const Light& light,
            const FogMethodOptions& options)
      : volume_(scene, passes, volumeParameterization(), light, setupOf(view, options)) {
    if (options.marchMap != nullptr) map_.emplace(scene, passes, *options.marchMap, light, setupOf(view, options));
  }

  const Occluders& of(const MediaMethod& method) { return lightFor(method).occluders(); }
  // Wall clock of drawing what this method reads once more.
  double redraw(const MediaMethod& method) { return lightFor(method).redraw(); }

 private:
  static MapSetup setupOf(const FogView& view, const FogMethodOptions& options) {
    return {.side = options.mapSide, .options = options.map, .cull = options.cull, .receiversW = view.receiversW};
  }
  LightOnMap& lightFor(const MediaMethod& method) { return method.readsDepths() ? *map_ : volume_; }

  LightOnMap volume_;
  std::optional<LightOnMap> map_;  // of marches
};

struct PassTimes {
  double table = 0.0, integrate = 0.0;  // wall clock, milliseconds
};

PassTimes integrate(const SceneView& scene, MediaPass& pass, const Occluders& occluders, const MediaLightSource& light,
                    const MediaMethod& method, bool heterogeneous) {
  PassTimes times;
  if (occluders.bits() != nullptr || heterogeneous) {
    gpu::Commands commands(scene.device(), "media table");
    pass.recordTable(commands, occluders, light);
    times.table = commands.submitAndWait().wallMs;
  }
  gpu::Commands commands(scene.device(), "media integrate");
  pass.record(commands, scene.buffers(), scene.gbuffer(), occluders, light, method, false);
  times.integrate = commands.submitAndWait().wallMs;
  return times;
}

struct Samples {
  std::vector<double> map, table, integrate;
};

// Rounds run one after another through all methods, so that a machine that slows down slows all of them.
void timeMethods(const SceneView& scene, MediaPass& pass, LightMaps& maps, const MediaLightSource& light,
                 bool heterogeneous, const FogMethodOptions& options, std::vector<FogMethodResult>& results) {
  std::vector<Samples> samples(options.methods.size());
  for (int round = 0; round < options.repeats; ++round) {
    std::optional<double> mapMs[2];
    for (size_t i = 0; i < options.methods.size(); ++i) {
      const MediaMethod& method = options.methods[i];
      std::optional<double>& drawn = mapMs[method.readsDepths() ? 1 : 0];
      if (!drawn) drawn = maps.redraw(method);
      const PassTimes times = integrate(scene, pass, maps.of(method), light, method, heterogeneous);
      samples[i].map.push_back(*drawn);
      samples[i].table.push_back(times.table);
      samples[i].integrate.push_back(times.integrate);
    }
  }
  for (size_t i = 0; i < samples.size() && options.repeats > 0; ++i) {
    results[i].mapMs += median(samples[i].map);
    results[i].tableMs += median(samples[i].table);
    results[i].integrateMs += median(samples[i].integrate);
  }
}

}  // namespace

std::vector<FogMethodResult> runFogMethods(const SceneView& scene, ShadowPasses& passes, const FogView& view,
                                           const FogMethodOptions& options) {
  MediaPass pass(scene.device(), scene.view().width, scene.view().height);
  return runFogMethods(scene, passes, pass, view, options);
}

std::vector<FogMethodResult> runFogMethods(const SceneView& scene, ShadowPasses& passes, MediaPass& pass,
                                           const FogView& view, const FogMethodOptions& options) {
  const int width = scene.view().width, height = scene.view().height;
  pass.setMedium(scene.view(), view.medium, view.densityBuffers.get());
  const bool heterogeneous = view.densityBuffers != nullptr;
  std::vector<FogMethodResult> results(options.methods.size());
  for (FogMethodResult& result : results) result.inScattered = ImageF(width, height, 3);
  for (size_t l = 0; l < view.lights.size(); ++l) {
    LightMaps maps(scene, passes, view, view.lights[l], options);
    for (size_t i = 0; i < results.size(); ++i) {  // pipelines compile here, before anything is timed
      integrate(scene, pass, maps.of(options.methods[i]), view.sources[l], options.methods[i], heterogeneous);
      const auto scattered = gpu::downloadAs<float>(scene.device(), pass.inScattered());
      std::ranges::transform(results[i].inScattered.values, scattered, results[i].inScattered.values.begin(),
                             std::plus<float>());
    }
    timeMethods(scene, pass, maps, view.sources[l], heterogeneous, options, results);
  }
  return results;
}

}  // namespace gnomon
