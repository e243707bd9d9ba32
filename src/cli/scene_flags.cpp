#include "cli/scene_flags.h"

#include "base/progress.h"
#include "gpu/shader_compiler.h"

#include <CLI/CLI.hpp>

namespace gnomon {

void addSceneFlags(CLI::App& verb, SceneFlags& flags) {
  SetupOptions& setup = flags.setup;
  verb.add_option("SCENE", setup.scene,
                  "a glTF file (.gltf, .glb), or the name of a generated scene (`gnomon scene` lists them)")
      ->required();
  verb.add_option("--light", setup.light,
                  "NAME of a light in the scene, a position x,y,z in metres, or all (each light on its own, then "
                  "their sum); default: the scene's first light that the map supports, else one above the scene's "
                  "centre (below the roof, if there is one)");
  verb.add_option("--camera", setup.camera,
                  "NAME of a camera in the scene, or eye:x,y,z,target:x,y,z[,fov:degrees] (vertical); default: the "
                  "scene's first camera, else one that sees the whole scene");
  verb.add_option("--direction", setup.direction,
                  "x,y,z: direction in which the light shines, for spot and directional maps; default: the light's "
                  "own; for a point light, the mean direction to the visible surfaces that it lights");
  verb.add_option("--cone", setup.coneDegrees,
                  "full angle of the spot's cone, degrees; default: the spot light's own, else 120. Pixels outside "
                  "the cone are dark and not scored");
  verb.add_option("--size", setup.size, "picture size: N or WxH, pixels")->capture_default_str();
  verb.add_option("--device", flags.device,
                  "part of a Vulkan device's name; default: a GPU if there is one, else the CPU device (lavapipe)");
  verb.add_option_function<std::string>(
      "--shader-dir", [](const std::string& folder) { gpu::setShaderDirectory(folder); },
      "read shaders from this folder instead of the built-in ones, to edit them without rebuilding");
  verb.add_flag_callback(
      "--quiet", [] { Progress::setQuiet(true); }, "no progress display");
}

Session openSession(const SceneFlags& flags) {
  return Session({.name = flags.device}, flags.setup);
}

}  // namespace gnomon
