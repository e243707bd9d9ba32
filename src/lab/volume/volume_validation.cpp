#include "lab/volume/volume_validation.h"

#include "base/check.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "lab/picture/pictures.h"
#include "lab/volume/volume_pictures.h"
#include "vsv/volume_parameterization.h"

#include <chrono>

#include <fmt/format.h>

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

// Milliseconds since the last call, or since it was made.
class StopWatch {
 public:
  double lap() {
    const Clock::time_point now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  Clock::time_point last_ = Clock::now();
};

const ShadowVolume& build(LightOnMap& lit, VolumeTimes& times) {
  times.fit = lit.fitMs();
  const ShadowVolume& volume = asVolume(lit.occluders());  // compiles
  times.build = lit.redraw();
  gpu::Commands bits(lit.view().device(), "shadow volume's bits");
  volume.recordBits(bits, lit.passes().maps.programs(), Voxelization::Fused);
  times.bits = bits.submitAndWait().wallMs;
  return volume;
}

// Two counts of the same thing, by bits and by OpenVDB: a difference would be a defect of the check.
void checkCounts(const VolumeValidation& v) {
  GNOMON_CHECK_EQ(v.impliedDifference.onlyFirst + v.impliedDifference.onlySecond,
                  v.source.sameMap.mismatches + v.source.sameMap.withinTolerance);
  if (v.litBehind > 0) return;  // boundaries then tell only of the first bits
  GNOMON_CHECK_EQ(v.exactDifference.onlyFirst, v.exact.tooDark);
  GNOMON_CHECK_EQ(v.exactDifference.onlySecond, v.exact.tooLight);
}

VolumeValidation validate(const Session& session, const ShadowVolume& volume, const DenseVolume& measured,
                          const VolumeGrid& grid, const ExactVolume& exact, VolumeTimes& times) {
  VolumeValidation v;
  StopWatch watch;
  v.source = checkSource(session.device(), volume, measured);
  v.impliedDifference = compareGrids(grid, VolumeGrid(volumeOf(v.source.implied)));
  times.implied = watch.lap();
  const FoundBoundaries found = boundariesOf(measured);
  v.litBehind = found.litBehind;
  v.exact = compareBoundaries(session.tracer(), volume.fitted().frame, exact, found.boundaries, columnSource(volume),
                              endMargin(session.scene()));
  v.exactDifference = compareGrids(grid, VolumeGrid(volumeOf(exact.boundaries)));
  times.compareExact = watch.lap();
  checkCounts(v);
  return v;
}

Pictures writePictures(const LightOnMap& lit, const DenseVolume& measured, const ColumnBoundaries& boundaries,
                       const std::filesystem::path& outDir) {
  Pictures pictures;
  const auto write = [&](const std::string& name, const Image8& image) {
    writePng(outDir / (name + ".png"), image);
    pictures.emplace_back(name, name + ".png");
  };
  for (const SliceAxis axis : {SliceAxis::Alpha, SliceAxis::Theta, SliceAxis::Phi})
    write(fmt::format("slice_{}", sliceAxisName(axis)),
          slicePicture(measured, boundaries, axis, busiestSlice(boundaries, axis)));
  const Image8 camera = toSrgb8(lit.radiance(truthVisibility(lit.receivers(), lit.truth())));
  write("coordinates", coordinatePicture(camera, lit.view().view(), lit.fitted().frame, measured.grid));
  return pictures;
}

}  // namespace

bool VolumeResult::sound() const {
  if (!validation) return true;
  const SourceCheck& source = validation->source;
  return source.sameMap.mismatches == 0 && source.sameOccluders.mismatches == 0 && source.occluders.beyond == 0 &&
         validation->litBehind == 0;
}

VolumeResult examineVolume(const Session& session, const VolumeOptions& options) {
  const bool traces = options.validate || !options.outDir.empty();
  Progress progress("vsv", 2 + (traces ? 1 : 0) + (options.validate ? 1 : 0) + (options.vdb.empty() ? 0 : 1));
  const auto step = [&](const std::string& what) {
    throwIfInterrupted();
    progress.step(what);
  };
  ShadowPasses passes(session);
  VolumeResult result;
  step("building the volume");
  LightOnMap lit = openLight(session, passes, volumeParameterization(),
                             {.side = options.mapSide, .options = options.map, .cull = options.cull});
  const ShadowVolume& volume = build(lit, result.times);
  result.columns = volume.fitted();
  result.light = lit.source();

  step("reading it back");
  StopWatch watch;
  const DenseVolume measured = denseOf(downloadBits(session.device(), volume));
  result.times.download = watch.lap();
  const VolumeGrid grid(measured);
  result.times.grid = watch.lap();
  result.voxels = voxelCount(measured.grid);
  result.occluded = occludedCount(measured);
  GNOMON_CHECK_EQ(result.occluded, grid.activeVoxels());
  result.denseBytes = measured.words.size() * sizeof(uint64_t);
  result.gridBytes = grid.memoryBytes();
  result.gridTiles = grid.tileCount();
  result.gridLeaves = grid.leafCount();

  const glsl::LightFrame& frame = result.columns.frame;
  if (traces) {
    step("tracing every column");
    watch.lap();
    const ExactVolume exact = traceColumns(session.tracer(), frame, measured.grid);
    result.times.trace = watch.lap();
    if (options.validate) {
      step("comparing");
      result.validation = validate(session, volume, measured, grid, exact, result.times);
    }
    if (!options.outDir.empty()) result.pictures = writePictures(lit, measured, exact.boundaries, options.outDir);
  }
  throwIfInterrupted();
  if (!options.vdb.empty()) {
    progress.step("writing " + options.vdb.string());
    watch.lap();
    VdbOptions vdb{.source = fmt::format("{}, {}", options.map.text(kVolumeSource), options.map.text(kVolumeFit)),
                   .command = options.command,
                   .voxelMetres = options.vdbVoxel};
    vdb.boundsW = computeBounds(session.scene());
    vdb.frame = frame;
    result.vdb = writeVdb(options.vdb, grid, measured, vdb);
    result.times.vdb = watch.lap();
  }
  return result;
}

}  // namespace gnomon
