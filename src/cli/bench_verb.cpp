#include "base/file.h"
#include "cli/common_flags.h"
#include "cli/verbs.h"
#include "lab/bench/bench.h"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct BenchFlags {
  SceneFlags scene;
  MethodFlags method;  // --map-texels, --cull and those of volumes
  int repeats = 9;
  bool noGrowth = false;
  bool noStart = false;
  long mostTriangles = 10'000'000;
  std::string json;
  std::string svg;
};

int runBenchVerb(const BenchFlags& flags) {
  BenchOptions options{.mapTexels = flags.method.mapTexels,
                       .cull = parseCullMode(flags.method.cull),
                       .repeats = flags.repeats,
                       .growth = !flags.noGrowth,
                       .mostTriangles = flags.mostTriangles};
  options.mapOptions.volumeSize = parseVolumeSize(flags.method.vsvSize);
  options.mapOptions.volumeFit = parseVolumeFit(flags.method.vsvFit);
  if (!flags.noStart) options.program = "/proc/self/exe";
  if (!options.program.empty()) options.program = std::filesystem::read_symlink(options.program);
  const Session session = openSession(flags.scene);
  const Bench bench = runBench(session, {.name = flags.scene.device}, options);
  if (!flags.json.empty()) writeTextFile(flags.json, benchJson(session, bench, commandLine()));
  if (!flags.svg.empty()) writeTextFile(flags.svg, growthSvg(bench.growths));
  std::fputs(benchTable(session, bench).c_str(), stdout);
  return 0;
}

}  // namespace

Run addBenchVerb(CLI::App& app) {
  auto flags = std::make_shared<BenchFlags>();
  flags->scene.setup.scene = "atrium";
  flags->method.mapTexels = 6291456;
  CLI::App* verb = app.add_subcommand(
      "bench", "what every stage costs, as ratios of one run, and how that grows; default scene: atrium");
  addSceneFlags(*verb, flags->scene);
  verb->get_option("SCENE")->required(false);
  verb->add_option("--map-texels", flags->method.mapTexels, "texels of all layers of a map together")
      ->check(CLI::Range(64L, 1L << 32))
      ->capture_default_str();
  verb->add_option("--cull", flags->method.cull,
                   "solids: closed one-sided meshes cast by their lit faces only; none: everything casts")
      ->capture_default_str();
  verb->add_option("--vsv-size", flags->method.vsvSize,
                   "voxels of a shadow volume, ALPHAxTHETAxPHI; PHI a multiple of 128")
      ->capture_default_str();
  verb->add_option("--vsv-fit", flags->method.vsvFit, "what a volume covers: frustum or full")->capture_default_str();
  verb->add_option("--repeats", flags->repeats, "rounds; medians are told")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_flag("--no-growth", flags->noGrowth, "leave out how costs grow with triangles, map, picture and volume");
  verb->add_flag("--no-start", flags->noStart, "leave out the time from typing gnomon render to the picture");
  verb->add_option("--most-triangles", flags->mostTriangles, "where the growth with triangles ends")
      ->check(CLI::Range(10'000L, 19'000'000L))
      ->capture_default_str();
  verb->add_option("--json", flags->json, "write the numbers here");
  verb->add_option("--svg", flags->svg, "write the curves of the growth here");
  return [flags] { return runBenchVerb(*flags); };
}

}  // namespace gnomon
