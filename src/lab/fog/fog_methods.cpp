#include "lab/fog/fog_methods.h"

#include "lab/core/method.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

bool marchesMap(const MediaMethod& method) {
  return method.integrator == Integrator::March;
}

// One light's volume and map, drawn for the methods that read them.
class LightMaps {
 public:
  LightMaps(const Session& session, const Renderers& renderers, const FogView& view, const Light& light,
            const FogMethodOptions& options)
      : session_(session), renderers_(renderers), options_(options) {
    if (std::ranges::any_of(options.methods, marchesMap)) map_ = draw(view, light, *options.marchMap);
    if (!std::ranges::all_of(options.methods, marchesMap)) volume_ = draw(view, light, volumeParameterization());
  }

  MediaVisibility of(const MediaMethod& method) const {
    if (marchesMap(method)) return {*map_->drawn.image};
    return {*volume_->drawn.volume};
  }

  // Wall clock of drawing what this method reads once more.
  double redraw(const MediaMethod& method) const {
    const Drawn& drawn = marchesMap(method) ? *map_ : *volume_;
    return redrawMap(session_, renderers_, drawn.drawn, drawn.exact, options_.cull);
  }

 private:
  struct Drawn {
    Exact exact;
    DrawnMap drawn;
  };

  std::unique_ptr<Drawn> draw(const FogView& view, const Light& light, const Parameterization& map) const {
    auto made = std::make_unique<Drawn>();
    made->exact = {.source = light, .light = map.lightModel(light, glm::dvec3(0.0))};
    const FittedMap fitted = map.fit({.scene = session_.scene(),
                                      .light = made->exact.light,
                                      .receiversW = view.receiversW,
                                      .side = options_.mapSide,
                                      .camera = session_.view(),
                                      .options = options_.map});
    made->drawn = drawMap(session_, renderers_, fitted, made->exact, glsl::kChannelDepth, options_.cull);
    return made;
  }

  const Session& session_;
  const Renderers& renderers_;
  const FogMethodOptions& options_;
  std::unique_ptr<Drawn> map_, volume_;
};

struct PassTimes {
  double table = 0.0, integrate = 0.0;  // wall clock, milliseconds
};

PassTimes integrate(const Session& session, MediaPass& pass, const MediaVisibility& visibility,
                    const MediaLightSource& light, const MediaMethod& method, bool heterogeneous) {
  PassTimes times;
  if (visibility.volume != nullptr || heterogeneous) {
    gpu::Commands commands(session.device(), "media table");
    pass.recordTable(commands, visibility, light);
    times.table = commands.submitAndWait().wallMs;
  }
  gpu::Commands commands(session.device(), "media integrate");
  pass.record(commands, session.buffers(), session.gbuffer(), visibility, light, method, false);
  times.integrate = commands.submitAndWait().wallMs;
  return times;
}

struct Samples {
  std::vector<double> map, table, integrate;
};

// Rounds run one after another through all methods, so that a machine that slows down slows all of them.
void timeMethods(const Session& session, MediaPass& pass, const LightMaps& maps, const MediaLightSource& light,
                 bool heterogeneous, const FogMethodOptions& options, std::vector<FogMethodResult>& results) {
  std::vector<Samples> samples(options.methods.size());
  for (int round = 0; round < options.repeats; ++round) {
    std::optional<double> mapMs[2];
    for (size_t i = 0; i < options.methods.size(); ++i) {
      const MediaMethod& method = options.methods[i];
      std::optional<double>& drawn = mapMs[marchesMap(method) ? 1 : 0];
      if (!drawn) drawn = maps.redraw(method);
      const PassTimes times = integrate(session, pass, maps.of(method), light, method, heterogeneous);
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

std::vector<FogMethodResult> runFogMethods(const Session& session, const Renderers& renderers, const FogView& view,
                                           const FogMethodOptions& options) {
  const int width = session.view().width, height = session.view().height;
  MediaPass pass(session.device(), width, height);
  pass.setMedium(session.view(), view.medium, view.densityBuffers.get());
  const bool heterogeneous = view.densityBuffers != nullptr;
  std::vector<FogMethodResult> results(options.methods.size());
  for (FogMethodResult& result : results) result.inScattered = ImageF(width, height, 3);
  for (size_t l = 0; l < view.lights.size(); ++l) {
    const LightMaps maps(session, renderers, view, view.lights[l], options);
    for (size_t i = 0; i < results.size(); ++i) {  // pipelines compile here, before anything is timed
      integrate(session, pass, maps.of(options.methods[i]), view.sources[l], options.methods[i], heterogeneous);
      const auto scattered = gpu::downloadAs<float>(session.device(), pass.inScattered());
      std::ranges::transform(results[i].inScattered.values, scattered, results[i].inScattered.values.begin(),
                             std::plus<float>());
    }
    timeMethods(session, pass, maps, view.sources[l], heterogeneous, options, results);
  }
  return results;
}

std::string mediaMethodName(const MediaMethod& method) {
  const std::string name = integratorName(method.integrator);
  return method.steps > 0 ? fmt::format("{} {}", name, method.steps) : name;
}

}  // namespace gnomon
