#include "base/error.h"
#include "base/file.h"
#include "base/terminal.h"
#include "cli/offers.h"
#include "cli/scene_flags.h"
#include "cli/verbs.h"
#include "scene/generate.h"
#include "scene/gltf.h"
#include "vsv/media/generate_density.h"

#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct SceneVerbFlags {
  std::string name;
  std::string out;
  std::string density;
  std::string densityFor = "grate";
  uint32_t seed = 1;
};

int listScenes() {
  for (const GeneratedScene& scene : generatedScenes()) say(fmt::format("{:<14} {}\n", scene.name, scene.provokes));
  say("\ndensities, with --density NAME:\n");
  for (const GeneratedDensity& density : generatedDensities())
    say(fmt::format("{:<14} {}\n", density.name, density.sentence));
  return 0;
}

// Where to write, which must end in `extension`.
std::filesystem::path outputOf(const SceneVerbFlags& flags, const char* what, const char* extension) {
  if (flags.out.empty()) throw UsageError(fmt::format("{}: give the output file, -o FILE{}", what, extension));
  if (std::filesystem::path(flags.out).extension() != extension && !isStream(flags.out))
    throw UsageError(fmt::format("-o {}: the name must end in {}", flags.out, extension));
  checkOutput(flags.out);
  return flags.out;
}

int writeScene(const SceneVerbFlags& flags) {
  const std::filesystem::path out = outputOf(flags, fmt::format("scene {}", flags.name).c_str(), ".glb");
  const Scene scene = openScene(flags.name);
  saveGlb(scene, out);
  say(fmt::format("wrote {}: {} triangles\n", flags.out, triangleCount(scene)));
  return 0;
}

int writeDensity(const SceneVerbFlags& flags) {
  if (!flags.name.empty())
    throw UsageError(
        fmt::format("--density {}: give the scene that it fills with --for {}", flags.density, flags.name));
  const std::filesystem::path out = outputOf(flags, fmt::format("--density {}", flags.density).c_str(), ".vdb");
  const Bounds boundsW = computeBounds(openScene(flags.densityFor));
  const DensitySummary summary = writeGeneratedDensity(flags.density, boundsW, flags.seed, out);
  say(fmt::format("wrote {}: {} voxels of {:.3g} m\n", flags.out, summary.voxels, summary.voxelMetres));
  return 0;
}

int runScene(const SceneVerbFlags& flags) {
  if (!flags.density.empty()) return writeDensity(flags);
  return flags.name.empty() ? listScenes() : writeScene(flags);
}

Run addScene(CLI::App* verb) {
  auto flags = std::make_shared<SceneVerbFlags>();
  std::vector<std::string> densities;
  for (const GeneratedDensity& density : generatedDensities()) densities.emplace_back(density.name);
  offersOneOf(verb->add_option("NAME", flags->name, "a generated scene, `crowd:N` for about N triangles"),
              sceneNames());
  offersFiles(verb->add_option("-o,--out", flags->out, "FILE.glb, or FILE.vdb for a density"));
  CLI::Option* density = verb->add_option("--density", flags->density, "a generated density instead of a scene");
  offersOneOf(density, densities);
  offersFiles(verb->add_option("--for", flags->densityFor,
                               "scene whose bounds the density fills: a generated scene or a glTF "
                               "file")
                  ->capture_default_str()
                  ->needs(density),
              sceneNames());
  verb->add_option("--seed", flags->seed, "seed of the noise")->capture_default_str()->needs(density);
  return [flags] { return runScene(*flags); };
}

}  // namespace

Verb sceneVerb() {
  return {.name = "scene",
          .sentence = "writes a generated scene as glTF, or a density as OpenVDB; without a name, lists them",
          .add = addScene};
}

}  // namespace gnomon
