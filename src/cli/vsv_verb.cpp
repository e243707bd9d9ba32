#include "base/error.h"
#include "base/file.h"
#include "base/image.h"
#include "base/interrupt.h"
#include "base/terminal.h"
#include "cli/map_flags.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "cli/output_flags.h"
#include "cli/scene_flags.h"
#include "cli/typed_command.h"
#include "cli/verbs.h"
#include "lab/results/result_folder.h"
#include "lab/volume/volume_report.h"
#include "vsv/volume_parameterization.h"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct VsvFlags {
  SceneFlags scene;
  MapFlags map;  // --map-size, --cull and those of volumes
  bool validate = false;
  std::string out;
  std::string json;
  std::string vdb;
  std::optional<double> vdbVoxel;
};

VolumeOptions volumeOptions(const VsvFlags& flags, const std::filesystem::path& outDir) {
  VolumeOptions options{.map = flags.map.options,
                        .mapSide = flags.map.mapSize,
                        .cull = parseCullMode(flags.map.cull),
                        .validate = flags.validate,
                        .outDir = outDir,
                        .vdb = flags.vdb,
                        .command = commandLine()};
  if (!flags.vdb.empty() && options.vdb.extension() != ".vdb" && !isStream(options.vdb))
    throw UsageError(fmt::format("--vdb {}: the name must end in .vdb", flags.vdb));
  if (flags.vdbVoxel) {
    if (flags.vdb.empty()) throw UsageError("--vdb-voxel needs a --vdb");
    if (!(*flags.vdbVoxel > 0.0 && *flags.vdbVoxel < 1e6))
      throw UsageError(fmt::format("--vdb-voxel {}: give metres, more than 0 and less than 1e6", *flags.vdbVoxel));
    options.vdbVoxel = *flags.vdbVoxel;
  }
  return options;
}

int runVsv(const VsvFlags& flags) {
  checkFolderName(flags.out,
                  "name a folder without such an ending; --vdb FILE.vdb is the volume, --json FILE its numbers");
  refuseAllLights(flags.scene, "vsv");
  for (const std::string& file : {flags.json, flags.vdb})
    if (!file.empty()) checkOutput(file);
  const InterruptGuard guard;  // before there is a folder that must not stay
  ResultFolder folder(flags.out, "volume.json");
  const VolumeOptions options = volumeOptions(flags, folder.aside());
  if (!flags.out.empty()) preloadImages();
  const Session session = openSession(flags.scene);
  const VolumeResult result = examineVolume(session, options);
  const std::string json = volumeJson(session, options, result);
  if (!flags.out.empty()) writeTextFile(options.outDir / "volume.json", json);
  folder.publish();
  if (!flags.json.empty()) writeTextFile(flags.json, json);
  say(volumeTable(session, options, result));
  if (!flags.out.empty()) say(fmt::format("wrote {0}/volume.json and pictures below {0}\n", flags.out));
  if (result.sound()) return 0;
  std::fprintf(stderr,
               "gnomon: the volume differs from the CPU's rebuild from the same depth map: see 'same map' above\n");
  return 3;
}

Run addVsv(CLI::App* verb) {
  auto flags = std::make_shared<VsvFlags>();
  addSceneFlags(*verb, flags->scene);
  const OptionGroup group(*verb, "Volume and output");
  addMapOptionFlags(*verb, flags->map, volumeParameterization().options());
  verb->add_option("--map-size", flags->map.mapSize, "side of the cube map's faces for --vsv-source resample, texels")
      ->check(CLI::Range(2, 16384))
      ->capture_default_str();
  addCullFlag(*verb, flags->map);
  verb->add_flag("--validate", flags->validate,
                 "compare every voxel with a CPU rebuild from the same depth map (exit code 3 if one differs beyond "
                 "rounding), and every column with a traced ray");
  offersFolders(verb->add_option("-o,--out", flags->out, "folder for pictures (slices, coordinates) and volume.json"));
  offersFiles(verb->add_option("--json", flags->json, "write volume.json here"));
  offersFiles(verb->add_option("--vdb", flags->vdb,
                               "write an OpenVDB file: the voxels as a mask, and a world-space density, 1 in shadow"));
  verb->add_option("--vdb-voxel", flags->vdbVoxel,
                   "voxel size of the density, metres; default: the volume's mean voxel size");
  return [flags] { return runVsv(*flags); };
}

}  // namespace

Verb vsvVerb() {
  return {.name = "vsv",
          .sentence = "builds a voxelized shadow volume, checks it on the CPU, exports it as .vdb",
          .add = addVsv};
}

}  // namespace gnomon
