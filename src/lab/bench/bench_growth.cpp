#include "base/error.h"
#include "base/progress.h"
#include "lab/bench/bench.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "truth/visibility.h"
#include "vsv/volume_parameterization.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr int kMostRepeats = 5;  // a point of a curve needs less than a number in a table

struct Stage {
  std::string name;
  std::function<double()> run;  // milliseconds
};

class Curves {
 public:
  Curves(std::string size, std::string unit, int repeats)
      : growth_{.size = std::move(size), .unit = std::move(unit), .stages = {}, .points = {}},
        repeats_(std::min(repeats, kMostRepeats)) {}

  void addPoint(double size, std::string name, const std::vector<Stage>& stages) {
    Growth::Point point{.size = size, .name = std::move(name), .ms = {}, .cpuMs = {}};
    std::vector<std::string> names;
    for (const Stage& stage : stages) {
      stage.run();
      std::vector<double> times, cpuTimes;
      for (int i = 0; i < repeats_; ++i) {
        const double before = processorMs();
        times.push_back(stage.run());
        cpuTimes.push_back(processorMs() - before);
      }
      names.push_back(stage.name);
      point.ms.push_back(median(times));
      point.cpuMs.push_back(median(cpuTimes));
    }
    growth_.stages = std::move(names);
    growth_.points.push_back(std::move(point));
  }
  size_t pointCount() const { return growth_.points.size(); }
  Growth take() { return std::move(growth_); }

 private:
  Growth growth_;
  int repeats_;
};

constexpr ChannelSet kTwoLayers = glsl::kChannelDepth | glsl::kChannelSecondDepth;

// A light on a map whose stages are timed.
class Subject {
 public:
  Subject(const Session& session, const Parameterization& kind, int side, const BenchOptions& options)
      : passes_(session),
        lit_(openLight(session, passes_, kind, {.side = side, .options = options.mapOptions, .cull = options.cull})) {}

  double build(ChannelSet channels) { return lit_.redraw(channels); }
  double look(const char* bias) { return lit_.timeVisibility(atDefaults(findBias(bias), lit_.view())); }
  double bits() {
    gpu::Commands commands(lit_.view().device(), "bits");
    asVolume(lit_.occluders()).recordBits(commands, passes_.maps.programs(), Voxelization::Fused);
    return commands.submitAndWait().wallMs;
  }
  double trace() {
    const auto start = std::chrono::steady_clock::now();
    computeTruth(lit_.view().tracer(), lit_.light(), lit_.receivers());
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  ShadowPasses passes_;
  LightOnMap lit_;
};

Growth withTriangles(const gpu::DeviceOptions& device, const BenchOptions& options) {
  Curves curves("triangles", "triangles of the scene crowd:N, picture of 512 x 512, cube of 6 x 512 x 512",
                options.repeats);
  for (int64_t count = 10'000; count <= options.mostTriangles; count *= 10) {
    const Session session(device, {.scene = fmt::format("crowd:{}", count), .size = "512"});
    Subject cube(session, cubeParameterization(), 512, options);
    curves.addPoint(static_cast<double>(triangleCount(session.scene())), fmt::format("{}", count),
                    {{"gbuffer", [&] { return session.timeGBuffer(); }},
                     {"cube, one layer", [&] { return cube.build(glsl::kChannelDepth); }},
                     {"cube, two layers", [&] { return cube.build(kTwoLayers); }},
                     {"visibility, constant", [&] { return cube.look("constant"); }},
                     {"exact shadow", [&] { return cube.trace(); }}});
  }
  return curves.take();
}

// A quarter of a side to four times it.
std::vector<int64_t> sidesAround(int64_t side) {
  return {std::max<int64_t>(side / 4, 2), std::max<int64_t>(side / 2, 4), std::max<int64_t>(side, 8), 2 * side,
          4 * side};
}

Growth withMapSize(const Session& session, const BenchOptions& options) {
  Curves curves("map texels", "texels of all slices", options.repeats);
  const auto cubeSide = std::lround(std::sqrt(static_cast<double>(options.mapTexels) / 6.0));
  for (const int64_t side : sidesAround(std::clamp<int64_t>(cubeSide, 8, 2048))) {
    try {
      const int64_t texels = 6 * side * side;
      const int paraboloidSide = static_cast<int>(std::lround(std::sqrt(static_cast<double>(texels) / 2.0)));
      Subject cube(session, cubeParameterization(), static_cast<int>(side), options);
      Subject paraboloid(session, paraboloidParameterization(), paraboloidSide, options);
      curves.addPoint(static_cast<double>(texels), fmt::format("{}", texels),
                      {{"cube, one layer", [&] { return cube.build(glsl::kChannelDepth); }},
                       {"cube, two layers", [&] { return cube.build(kTwoLayers); }},
                       {"paraboloid, one layer", [&] { return paraboloid.build(glsl::kChannelDepth); }},
                       {"visibility, cube, constant", [&] { return cube.look("constant"); }},
                       {"visibility, cube, adaptive", [&] { return cube.look("adaptive"); }}});
    } catch (const WorldError&) {  // larger than the device can hold
      if (curves.pointCount() < 2) throw;
      break;
    }
  }
  return curves.take();
}

Growth withPictureSize(const Session& given, const gpu::DeviceOptions& device, const BenchOptions& options) {
  Curves curves("pixels", "pixels of the picture, square, cube of 6 x 512 x 512", options.repeats);
  const int64_t larger = std::max(given.view().width, given.view().height);
  for (const int64_t side : sidesAround(std::clamp<int64_t>(larger, 8, 4096))) {
    try {
      SetupOptions setup = given.setup();
      setup.size = fmt::format("{}", side);
      const Session session(device, setup);
      Subject cube(session, cubeParameterization(), 512, options);
      curves.addPoint(static_cast<double>(side * side), setup.size,
                      {{"gbuffer", [&] { return session.timeGBuffer(); }},
                       {"visibility, constant", [&] { return cube.look("constant"); }},
                       {"visibility, adaptive", [&] { return cube.look("adaptive"); }},
                       {"visibility, dual", [&] { return cube.look("dual"); }},
                       {"exact shadow", [&] { return cube.trace(); }}});
    } catch (const WorldError&) {  // larger than the device can hold
      if (curves.pointCount() < 2) throw;
      break;
    }
  }
  return curves.take();
}

Growth withVolumeSize(const Session& session, const BenchOptions& options) {
  Curves curves("voxels", "voxels of the shadow volume, direct", options.repeats);
  for (const VolumeSize& size : {VolumeSize{256, 256, 256}, VolumeSize{512, 512, 256}, VolumeSize{512, 512, 512},
                                 VolumeSize{1024, 1024, 512}, VolumeSize{1024, 1024, 1024}}) {
    // A smaller volume asked for is a smaller measurement, but one point there always is.
    const VolumeSize& asked = options.mapOptions.get(kVolumeSize);
    const auto voxels = [](const VolumeSize& s) { return static_cast<double>(s.alpha) * s.theta * s.phi; };
    if (voxels(size) > 2.0 * voxels(asked) && size.alpha > 256) continue;
    BenchOptions sized = options;
    sized.mapOptions = options.mapOptions.with(kVolumeSize(size)).with(kVolumeSource(VolumeSource::Direct));
    Subject volume(session, volumeParameterization(), 1024, sized);
    curves.addPoint(static_cast<double>(size.alpha) * size.theta * size.phi, volumeSizeName(size),
                    {{"volume, all", [&] { return volume.build(glsl::kChannelDepth); }},
                     {"volume, bits", [&] { return volume.bits(); }},
                     {"visibility, adaptive", [&] { return volume.look("adaptive"); }}});
  }
  return curves.take();
}

}  // namespace

std::vector<Growth> measureGrowth(const Session& session, const gpu::DeviceOptions& device,
                                  const BenchOptions& options) {
  Progress progress("bench", 4);
  std::vector<Growth> growths;
  progress.step("growth with map size");
  growths.push_back(withMapSize(session, options));
  progress.step("growth with picture size");
  growths.push_back(withPictureSize(session, device, options));
  progress.step("growth with volume size");
  growths.push_back(withVolumeSize(session, options));
  progress.step("growth with triangles");
  growths.push_back(withTriangles(device, options));
  return growths;
}

}  // namespace gnomon
