#include "lab/bench/bench.h"

#include "lab/bench/bare_rays.h"
#include "lab/bench/plain_forward.h"
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
constexpr const char* kPlainFrame = "baseline/forward";
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

// A light on a map, by the name of the way it is drawn.
struct BenchMap {
  std::string name;
  LightOnMap lit;
};

// A medium around it, with a volume and a cube that are fitted to all view rays.
struct BenchMedium {
  FogView view;
  LightOnMap volume, cube;
  MediaPass pass;
};

struct BenchStages::Maps {
  ShadowPasses passes;
  std::deque<BenchMap> all;  // pointers into it stay
  gpu::Buffer from, to;
  gpu::Image cleared;
  std::vector<std::byte> hostFrom, hostTo;
  std::unique_ptr<PlainForward> plain;
  std::unique_ptr<BareRays> bareRays;
  std::unique_ptr<BenchMedium> medium;

  Maps(const Session& session)
      : passes(session),
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
    all.push_back(
        {name, openLight(session, passes, kind, {.side = side, .options = mapOptions, .cull = options.cull})});
    return all.back();
  }
  BenchMap& named(const std::string& name) {
    return *std::ranges::find_if(all, [&](const BenchMap& map) { return map.name == name; });
  }
};

BenchStages::BenchStages(const Session& session, const BenchOptions& options)
    : session_(session), options_(options), maps_(std::make_unique<Maps>(session)) {
  addLimits();
  addMaps();
  addFrame();
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
                         std::initializer_list<ChannelSet> contents) {
    BenchMap& map = maps_->add(session_, options_, kind, name, options);
    for (const ChannelSet content : contents)
      add(fmt::format("map/{}/{}", name, contentName(content)), kBaseMap,
          [&map, content] { return map.lit.redraw(content); });
  };
  const MapOptions& given = options_.mapOptions;
  const auto buildWithVariants = [&](const Parameterization& kind) {
    build(kind.name(), kind, given,
          {glsl::kChannelDepth, glsl::kChannelDepth | glsl::kChannelSecondDepth, glsl::kChannelBackDepth,
           glsl::kChannelDepth | glsl::kChannelIds});
    for (const Parameterization::Variant& variant : kind.variants(given))
      build(fmt::format("{}, {}", kind.name(), variant.name), kind, variant.options, {glsl::kChannelDepth});
  };
  buildWithVariants(cubeParameterization());  // the yardstick
  for (const Parameterization* kind : otherMaps()) buildWithVariants(*kind);
}

// The frame as anybody would write it, and ours with the same map and light: from the cube to the shaded picture.
void BenchStages::addFrame() {
  BenchMap& cube = maps_->named("cube");
  const Method constant = atDefaults(findBias("constant"), session_);
  maps_->plain = std::make_unique<PlainForward>(session_, cube.lit, constant.params.knobs[0]);
  const auto plain = [this](bool map, bool picture) {
    gpu::Commands commands(session_.device(), "plain frame");
    if (map) maps_->plain->recordMap(commands);
    if (map && picture) commands.barrier("the plain cube is drawn -> the plain picture looks it up");
    if (picture) maps_->plain->recordPicture(commands);
    return commands.submitAndWait().wallMs;
  };
  add(kPlainFrame, kBaseMap, [plain] { return plain(true, true); });
  add("baseline/forward, its map", kBaseMap, [plain] { return plain(true, false); });
  add("baseline/forward, its picture", kBaseMap, [plain] { return plain(false, true); });
  for (const char* bias : {"constant", "adaptive", "dual"}) {
    const Method method = atDefaults(findBias(bias), session_);
    add(fmt::format("frame/cube/{}", bias), kPlainFrame,
        [&cube, method] { return cube.lit.timeFrame(method, glsl::kShadowFilterNone, true); });
    add(fmt::format("frame/cube/{}, its picture", bias), kPlainFrame,
        [&cube, method] { return cube.lit.timeFrame(method, glsl::kShadowFilterNone, false); });
  }
}

void BenchStages::addGBufferAndTruth() {
  add("gbuffer", kBaseMap, [this] { return session_.timeGBuffer(); });
  const LightOnMap& cube = maps_->named("cube").lit;
  maps_->bareRays = std::make_unique<BareRays>(session_.scene(), cube.light(), cube.receivers());
  add("limit/rtcOccluded16", kBaseVisibility, [this] { return maps_->bareRays->trace(); });
  add("truth/surfaces", "limit/rtcOccluded16", [this] {
    return millisecondsOf([&] { computeSurfaces(session_.tracer(), session_.view(), session_.primitiveIds()); });
  });
  add("truth/receivers, of one light", "limit/rtcOccluded16", [this, &cube] {
    return millisecondsOf([&] {
      computeReceivers(session_.tracer(), session_.view(), cube.light(), session_.primitiveIds(), session_.surfaces());
    });
  });
  add("truth/exact shadow", "limit/rtcOccluded16", [this, &cube] {
    return millisecondsOf([&] { computeTruth(session_.tracer(), cube.light(), cube.receivers()); });
  });
}

void BenchStages::addVisibility() {
  const auto look = [&](const std::string& mapName, const char* biasName, const Filter& filter) {
    BenchMap& map = maps_->named(mapName);
    const Method method = atDefaults(findBias(biasName), session_);
    const std::string suffix = filter.id == glsl::kShadowFilterNone ? std::string() : fmt::format(", {}", filter.name);
    add(fmt::format("visibility/{}/{}{}", mapName, biasName, suffix), kBaseVisibility,
        [&map, method, id = filter.id] { return map.lit.timeVisibility(method, id); });
  };
  look("cube", "constant", filters().front());
  for (const BiasMethod& bias : biasMethods())
    if (std::string_view(bias.name) != "constant") look("cube", bias.name, filters().front());
  addDecisions();
  for (const char* bias : {"constant", "adaptive", "dual"})
    for (size_t i = 1; i < filters().size(); ++i) look("cube", bias, filters()[i]);
  for (const Parameterization* map : otherMaps())
    for (const char* bias : {"constant", "adaptive", "dual"}) look(map->name(), bias, filters().front());
}

// What `compare` judges by: one bias and its diagnosis, and eight that share a dispatch.
void BenchStages::addDecisions() {
  LightOnMap& cube = maps_->named("cube").lit;
  std::vector<Method> methods;
  for (const BiasMethod& bias : biasMethods())
    if (bias.channels == glsl::kChannelDepth && methods.size() < static_cast<size_t>(glsl::kMostTogether))
      methods.push_back(atDefaults(bias, session_));
  add("decisions/cube, constant", kBaseVisibility, [&cube, method = atDefaults(findBias("constant"), session_)] {
    return millisecondsOf([&] { cube.diagnose(method); });
  });
  add(fmt::format("decisions/cube, {} biases", methods.size()), kBaseVisibility, [&cube, methods] {
    return millisecondsOf([&] {
      cube.expect(methods);
      for (const Method& method : methods) cube.diagnose(method);
      cube.expect({});
    });
  });
}

void BenchStages::addVolumes() {
  const gpu::Device& device = session_.device();
  const std::string copy = "volume/copy of its bits";
  for (const VolumeSource source : {VolumeSource::Direct, VolumeSource::Resample}) {
    const MapOptions options = options_.mapOptions.with(kVolumeSource(source));
    const std::string name = fmt::format("vsv, {}", kVolumeSource.text(source));
    BenchMap& map = maps_->add(session_, options_, volumeParameterization(), name, options);
    add(fmt::format("volume/{}/all", kVolumeSource.text(source)), kBaseMap, [&map] { return map.lit.redraw(); });
    if (source == VolumeSource::Direct) {
      const ShadowVolume& volume = asVolume(map.lit.occluders());
      const gpu::Buffer& bits = *volume.bits();
      auto to = std::make_shared<gpu::Buffer>(device, gpu::BufferDesc{.name = "bench volume", .size = bits.size()});
      add(copy, "limit/device copy 64 MiB", [&device, &bits, to] {
        gpu::Commands commands(device, "copy");
        commands.copy(bits, *to, bits.size());
        return commands.submitAndWait().wallMs;
      });
      for (const Voxelization how : {Voxelization::Fused, Voxelization::Passes})
        add(how == Voxelization::Fused ? "volume/bits, one pass" : "volume/bits, clear + seed + scan", copy,
            [this, &device, &volume, how] {
              gpu::Commands commands(device, "bits");
              volume.recordBits(commands, maps_->passes.maps.programs(), how);
              return commands.submitAndWait().wallMs;
            });
    }
    for (const char* biasName : {"none", "constant", "adaptive"}) {
      const Method method = atDefaults(findBias(biasName), session_);
      if (source == VolumeSource::Direct)
        add(fmt::format("visibility/vsv/{}", biasName), kBaseVisibility,
            [&map, method] { return map.lit.timeVisibility(method); });
    }
  }
}

void BenchStages::addMedia() {
  const Light& source = maps_->named("cube").lit.source();
  FogView view = lookIntoFog(session_, maps_->passes, {source}, {});
  const MapSetup setup{.options = options_.mapOptions, .cull = options_.cull, .receiversW = view.receiversW};
  const auto mapped = [&](const Parameterization& kind) {
    return LightOnMap(session_, maps_->passes, kind, source, setup);
  };
  maps_->medium.reset(new BenchMedium{std::move(view), mapped(volumeParameterization()), mapped(cubeParameterization()),
                                      MediaPass(session_.device(), session_.view().width, session_.view().height)});
  BenchMedium& medium = *maps_->medium;
  medium.pass.setMedium(session_.view(), medium.view.medium);
  const auto integrate = [&](std::string name, const char* base, const MediaMethod& method) {
    add(std::move(name), base, [this, &medium, method] {
      LightOnMap& lit = method.readsDepths() ? medium.cube : medium.volume;
      const Occluders& occluders = lit.occluders();
      gpu::Commands commands(session_.device(), "media");
      medium.pass.record(commands, session_.buffers(), session_.gbuffer(), occluders, medium.view.sources.front(),
                         method, false);
      return commands.submitAndWait().wallMs;
    });
  };
  constexpr const char* kBase = "media/march 32 steps";
  integrate(kBase, kBaseVisibility, {.integrator = &baselineIntegrator(), .steps = 32});
  for (const Integrator& integrator : integrators())
    for (const int steps : {32, 128, 512})
      if (integrator.takesSteps && !(integrator.isBaseline && steps == 32))
        integrate(fmt::format("media/{} {} steps", integrator.name, steps), kBase,
                  {.integrator = &integrator, .steps = steps});
  add("media/table of the running integral", kBase, [this, &medium] {
    const Occluders& occluders = medium.volume.occluders();
    gpu::Commands commands(session_.device(), "media table");
    medium.pass.recordTable(commands, occluders, medium.view.sources.front());
    return commands.submitAndWait().wallMs;
  });
  for (const Integrator& integrator : integrators())
    if (!integrator.takesSteps) integrate(fmt::format("media/{}", integrator.name), kBase, {.integrator = &integrator});
}

}  // namespace gnomon
