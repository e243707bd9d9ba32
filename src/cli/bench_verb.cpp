#include "base/file.h"
#include "base/terminal.h"
#include "cli/map_flags.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "cli/scene_flags.h"
#include "cli/typed_command.h"
#include "cli/verbs.h"
#include "lab/bench/bench.h"
#include "vsv/volume_parameterization.h"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct BenchFlags {
  SceneFlags scene;
  MapFlags map;  // --map-texels, --cull and those of volumes
  std::optional<int> mapSide;
  std::string only;
  int repeats = 9;
  bool noGrowth = false;
  bool noStart = false;
  long mostTriangles = 10'000'000;
  std::string json;
  std::string svg;
};

int runBenchVerb(const BenchFlags& flags) {
  BenchOptions options{.mapTexels = flags.map.mapTexels,
                       .mapOptions = flags.map.options,
                       .cull = parseCullMode(flags.map.cull),
                       .repeats = flags.repeats,
                       .only = flags.only.empty() ? std::vector<std::string>{} : CLI::detail::split(flags.only, ','),
                       .growth = !flags.noGrowth,
                       .mostTriangles = flags.mostTriangles};
  refuseAllLights(flags.scene, "bench");
  if (flags.mapSide) options.mapTexels = 6L * *flags.mapSide * *flags.mapSide;
  for (const std::string& file : {flags.json, flags.svg})
    if (!file.empty()) checkOutput(file);
  if (!flags.noStart) options.program = "/proc/self/exe";
  if (!options.program.empty()) options.program = std::filesystem::read_symlink(options.program);
  const Session session = openSession(flags.scene);
  const Bench bench = runBench(session, {.name = flags.scene.device}, options);
  if (!flags.json.empty()) writeTextFile(flags.json, benchJson(session, bench, commandLine()));
  if (!flags.svg.empty()) writeTextFile(flags.svg, growthSvg(bench.growths));
  say(benchTable(session, bench));
  return 0;
}

Run addBench(CLI::App* verb) {
  auto flags = std::make_shared<BenchFlags>();
  flags->scene.setup.scene = "atrium";
  flags->map.mapTexels = 6291456;
  addSceneFlags(*verb, flags->scene);
  verb->get_option("SCENE")->required(false);
  const OptionGroup group(*verb, "Measurement and output");
  CLI::Option* texels =
      verb->add_option("--map-texels", flags->map.mapTexels, "texels of each map, all its images together")
          ->check(CLI::Range(64L, 1L << 32))
          ->capture_default_str();
  verb->add_option(
          "--map-size", flags->mapSide,
          "the same as the side of a cube's faces: 6 N x N texels; the growths are measured around it and --size")
      ->check(CLI::Range(4, 16384))
      ->excludes(texels);
  addCullFlag(*verb, flags->map);
  addMapOptionFlags(*verb, flags->map, {&kVolumeSize, &kVolumeFit});
  verb->add_option("--repeats", flags->repeats, "rounds; medians are reported")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--only", flags->only,
                   "a,b: only the stages with one of these in their names, and those they are compared with");
  verb->add_flag("--no-growth", flags->noGrowth, "skip the scaling measurements (triangles, map, picture, volume)");
  verb->add_flag("--no-start", flags->noStart,
                 "skip the start-up measurement (from typing gnomon render to the picture)");
  verb->add_option("--most-triangles", flags->mostTriangles, "largest scene of the scaling measurement, triangles")
      ->check(CLI::Range(10'000L, 19'000'000L))
      ->capture_default_str();
  offersFiles(verb->add_option("--json", flags->json, "write the measurements to this JSON file"));
  offersFiles(verb->add_option("--svg", flags->svg, "write the scaling curves to this SVG file"));
  return [flags] { return runBenchVerb(*flags); };
}

}  // namespace

Verb benchVerb() {
  return {.name = "bench",
          .sentence = "times every stage, as ratios within one run, and how the times scale; default scene: atrium",
          .add = addBench};
}

}  // namespace gnomon
