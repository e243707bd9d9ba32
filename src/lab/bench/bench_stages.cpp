#include "lab/bench/bench.h"

#include "lab/core/map_set.h"
#include "lab/core/maps.h"
#include "lab/fog/fog_view.h"
#include "omni/cube_map.h"
#include "truth/visibility.h"
#include "vsv/volume_parameterization.h"

#include <chrono>
#include <cstring>
#include <deque>

#include <fmt/format.h>

namespace gnomon {

namespace {

// What every machine can do: the yardsticks.
constexpr const char* kEmpty = "limit/empty submission";
constexpr const char* kBaseMap = "map/cube/one layer";
constexpr const char* kBaseVisibility = "visibility/cube/constant";
constexpr uint64_t kCopiedBytes = 64 << 20;  // as many as a volume of 1024 x 1024 x 512 has

double millisecondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// All but the cube, against which the others are told, and the volume, which has stages of its own.
std::vector<const Parameterization*> otherMaps() {
  std::vector<const Parameterization*> maps = parameterizations();
  std::erase_if(maps, [](const Parameterization* map) {
    return map == &cubeParameterization() || map == &volumeParameterization();
  });
  return maps;
}

}  // namespace

// One light as one parameterization takes it, with one way to draw.
struct BenchMap {
  std::string name;
  Exact exact;
  std::unique_ptr<MapSet> set;
};

// A medium around it, with a volume and a cube that are fitted to all view rays.
struct BenchMedium {
  Exact exact;
  FogView view;
  DrawnMap volume, cube;
  MediaPass pass;
};

struct BenchStages::Maps {
  Passes passes;
  std::deque<BenchMap> all;  // pointers into it stay
  gpu::Buffer from, to;
  gpu::Image cleared;
  std::vector<std::byte> hostFrom, hostTo;
  std::unique_ptr<BenchMedium> medium;

  Maps(const Session& session)
      : passes(session.device(), session.view()),
        from(session.device(), {.name = "bench from", .size = kCopiedBytes}),
        to(session.device(), {.name = "bench to", .size = kCopiedBytes}),
        cleared(session.device(), {.name = "bench target",
                                   .format = VK_FORMAT_D32_SFLOAT,
                                   .width = 1024,
                                   .height = 1024,
                                   .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT}),
        hostFrom(kCopiedBytes, std::byte{1}),
        hostTo(kCopiedBytes, std::byte{2}) {}

  BenchMap& add(const Session& session, const BenchOptions& options, const Parameterization& kind,
                const std::string& name, const MapOptions& mapOptions) {
    MapChoice sized;
    sized.mapTexels = options.mapTexels;
    sized.mapOptions = mapOptions;
    const int side =
        &kind == &volumeParameterization() ? mapSideOf(sized, cubeParameterization()) : mapSideOf(sized, kind);
    all.push_back({.name = name, .exact = computeExact(session, kind), .set = nullptr});
    BenchMap& map = all.back();
    map.set = std::make_unique<MapSet>(
        session, passes.renderers, fitMap(session, kind, map.exact, side, mapOptions).fitted, map.exact, options.cull);
    return map;
  }
  BenchMap& named(const std::string& name) {
    return *std::ranges::find_if(all, [&](const BenchMap& map) { return map.name == name; });
  }
};

BenchStages::BenchStages(const Session& session, const BenchOptions& options)
    : session_(session), options_(options), maps_(std::make_unique<Maps>(session)) {
  addLimits();
  addMaps();
  addVisibility();
  addGBufferAndTruth();
  addVolumes();
  addMedia();
}

BenchStages::~BenchStages() = default;

void BenchStages::add(std::string name, std::string ratioTo, std::function<double()> run) {
  // The yardsticks themselves are told against the ones before them.
  if (name == kBaseMap) ratioTo = "limit/empty pass";
  if (name == kBaseVisibility) ratioTo = kBaseMap;
  stages_.push_back({std::move(name), std::move(ratioTo), std::move(run)});
}

void BenchStages::addLimits() {
  const gpu::Device& device = session_.device();
  Maps& maps = *maps_;
  add(kEmpty, "", [&device] { return gpu::Commands(device, "nothing").submitAndWait().wallMs; });
  add("limit/empty pass", kEmpty, [&device, &maps] {
    gpu::Commands commands(device, "empty pass");
    commands.beginRendering({.colors = {}, .depth = &maps.cleared, .clearDepth = 1.0f, .layer = {}});
    commands.endRendering();
    return commands.submitAndWait().wallMs;
  });
  add("limit/memcpy 64 MiB", "",
      [&maps] { return millisecondsOf([&] { std::memcpy(maps.hostTo.data(), maps.hostFrom.data(), kCopiedBytes); }); });
  add("limit/device copy 64 MiB", "limit/memcpy 64 MiB", [&device, &maps] {
    gpu::Commands commands(device, "copy");
    commands.copy(maps.from, maps.to, kCopiedBytes);
    return commands.submitAndWait().wallMs;
  });
}

void BenchStages::addMaps() {
  const auto build = [&](const std::string& name, const Parameterization& kind, const MapOptions& options,
                         std::initializer_list<MapContent> contents) {
    BenchMap& map = maps_->add(session_, options_, kind, name, options);
    for (const MapContent content : contents)
      add(fmt::format("map/{}/{}", name, contentName(content)), kBaseMap,
          [&map, content] { return map.set->redraw(content); });
  };
  const MapOptions& given = options_.mapOptions;
  const auto buildWithVariants = [&](const Parameterization& kind) {
    build(kind.name(), kind, given, {MapContent::OneLayer, MapContent::TwoLayers, MapContent::BackFaces});
    for (const Parameterization::Variant& variant : kind.variants(given))
      build(fmt::format("{}, {}", kind.name(), variant.name), kind, variant.options, {MapContent::OneLayer});
  };
  buildWithVariants(cubeParameterization());  // the yardstick
  for (const Parameterization* kind : otherMaps()) buildWithVariants(*kind);
}

void BenchStages::addGBufferAndTruth() {
  add("gbuffer", kBaseMap, [this] { return session_.timeGBuffer(); });
  const BenchMap& cube = maps_->named("cube");
  add("truth/exact shadow", kBaseVisibility, [this, &cube] {
    return millisecondsOf([&] { computeTruth(session_.tracer(), cube.exact.light, cube.exact.receivers); });
  });
}

void BenchStages::addVisibility() {
  const auto look = [&](const std::string& mapName, const char* biasName, const Filter& filter) {
    BenchMap& map = maps_->named(mapName);
    const BiasMethod& bias = findBias(biasName);
    const Method method = methodFor(session_, {}, bias);
    const std::string suffix = filter.id == glsl::kFilterNone ? std::string() : fmt::format(", {}", filter.name);
    add(fmt::format("visibility/{}/{}{}", mapName, biasName, suffix), kBaseVisibility,
        [this, &map, method, id = filter.id] {
          return timeVisibility(session_, maps_->passes, map.set->with(method.bias->content), map.exact, method, id);
        });
  };
  look("cube", "constant", filters().front());
  for (const BiasMethod& bias : biasMethods())
    if (std::string_view(bias.name) != "constant") look("cube", bias.name, filters().front());
  for (const char* bias : {"constant", "adaptive", "dual"})
    for (size_t i = 1; i < filters().size(); ++i) look("cube", bias, filters()[i]);
  for (const Parameterization* map : otherMaps())
    for (const char* bias : {"constant", "adaptive", "dual"}) look(map->name(), bias, filters().front());
}

void BenchStages::addVolumes() {
  const gpu::Device& device = session_.device();
  const std::string copy = "volume/copy of its bits";
  for (const VolumeSource source : {VolumeSource::Direct, VolumeSource::Resample}) {
    const MapOptions options = options_.mapOptions.with(kVolumeSource(source));
    const std::string name = fmt::format("vsv, {}", kVolumeSource.text(source));
    BenchMap& map = maps_->add(session_, options_, volumeParameterization(), name, options);
    add(fmt::format("volume/{}/all", kVolumeSource.text(source)), kBaseMap,
        [&map] { return map.set->redraw(MapContent::OneLayer); });
    if (source == VolumeSource::Direct) {
      const ShadowVolume& volume = *map.set->with(MapContent::OneLayer).volume;
      auto to =
          std::make_shared<gpu::Buffer>(device, gpu::BufferDesc{.name = "bench volume", .size = volume.bits().size()});
      add(copy, "limit/device copy 64 MiB", [&device, &volume, to] {
        gpu::Commands commands(device, "copy");
        commands.copy(volume.bits(), *to, volume.bits().size());
        return commands.submitAndWait().wallMs;
      });
      for (const Voxelization how : {Voxelization::Fused, Voxelization::Passes})
        add(how == Voxelization::Fused ? "volume/bits, one pass" : "volume/bits, clear + seed + scan", copy,
            [this, &device, &volume, how] {
              gpu::Commands commands(device, "bits");
              maps_->passes.renderers.volume.recordBits(commands, volume, how);
              return commands.submitAndWait().wallMs;
            });
    }
    for (const char* biasName : {"none", "constant", "adaptive"}) {
      const Method method = methodFor(session_, {}, findBias(biasName));
      if (source == VolumeSource::Direct)
        add(fmt::format("visibility/vsv/{}", biasName), kBaseVisibility, [this, &map, method] {
          return timeVisibility(session_, maps_->passes, map.set->with(MapContent::OneLayer), map.exact, method,
                                glsl::kFilterNone);
        });
    }
  }
}

void BenchStages::addMedia() {
  const Exact& exact = maps_->named("cube").exact;
  FogView view = lookIntoFog(session_, maps_->passes, {exact.source}, {});
  const auto draw = [&](const Parameterization& kind) {
    const FittedMap fitted = kind.fit({.scene = session_.scene(),
                                       .light = exact.light,
                                       .receiversW = view.receiversW,
                                       .camera = session_.view(),
                                       .options = options_.mapOptions});
    return drawMap(session_, maps_->passes.renderers, fitted, exact, MapContent::OneLayer, options_.cull);
  };
  DrawnMap volume = draw(volumeParameterization()), cube = draw(cubeParameterization());
  maps_->medium.reset(new BenchMedium{exact, std::move(view), std::move(volume), std::move(cube),
                                      MediaPass(session_.device(), session_.view().width, session_.view().height)});
  BenchMedium& medium = *maps_->medium;
  medium.pass.setMedium(session_.view(), medium.view.medium);
  const auto integrate = [&](std::string name, const char* base, const MediaMethod& method) {
    add(std::move(name), base, [this, &medium, method] {
      const MediaVisibility visibility = method.integrator == Integrator::March
                                             ? MediaVisibility(*medium.cube.image)
                                             : MediaVisibility(*medium.volume.volume);
      gpu::Commands commands(session_.device(), "media");
      medium.pass.record(commands, session_.buffers(), session_.gbuffer(), visibility, medium.view.sources.front(),
                         method, false);
      return commands.submitAndWait().wallMs;
    });
  };
  constexpr const char* kBase = "media/march 32 steps";
  integrate(kBase, kBaseVisibility, {.integrator = Integrator::March, .steps = 32});
  for (const int steps : {128, 512})
    integrate(fmt::format("media/march {} steps", steps), kBase, {.integrator = Integrator::March, .steps = steps});
  add("media/table of the running integral", kBase, [this, &medium] {
    gpu::Commands commands(session_.device(), "media table");
    medium.pass.recordTable(commands, *medium.volume.volume, medium.view.sources.front());
    return commands.submitAndWait().wallMs;
  });
  for (const Integrator integrator : {Integrator::Runs, Integrator::Bits, Integrator::Popcount})
    integrate(fmt::format("media/{}", integratorName(integrator)), kBase, {.integrator = integrator});
}

}  // namespace gnomon
