#include "base/error.h"
#include "cli/verbs.h"
#include "scene/generate.h"
#include "scene/gltf.h"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

struct SceneVerbFlags {
  std::string name;
  std::string out;
};

int listScenes() {
  for (const GeneratedScene& scene : generatedScenes()) std::printf("%-14s %s\n", scene.name, scene.provokes);
  return 0;
}

int runScene(const SceneVerbFlags& flags) {
  if (flags.name.empty()) return listScenes();
  if (flags.out.empty())
    throw UsageError(fmt::format("scene {}: say where to write it, with -o FILE.glb", flags.name));
  if (std::filesystem::path(flags.out).extension() != ".glb")
    throw UsageError(fmt::format("-o {}: write a .glb", flags.out));
  const Scene scene = openScene(flags.name);
  saveGlb(scene, flags.out);
  std::printf("wrote %s: %llu triangles\n", flags.out.c_str(),
              static_cast<unsigned long long>(triangleCount(scene)));
  return 0;
}

}  // namespace

Run addSceneVerb(CLI::App& app) {
  auto flags = std::make_shared<SceneVerbFlags>();
  CLI::App* verb = app.add_subcommand("scene", "write a generated scene as glTF; without a name, list them");
  verb->add_option("NAME", flags->name, "a generated scene, `crowd:N` for about N triangles");
  verb->add_option("-o,--out", flags->out, "FILE.glb");
  return [flags] { return runScene(*flags); };
}

}  // namespace gnomon
