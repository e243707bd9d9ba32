#include "cli/scene_flags.h"

#include "base/progress.h"
#include "gpu/shader_compiler.h"

#include <CLI/CLI.hpp>

namespace gnomon {

void addSceneFlags(CLI::App& verb, SceneFlags& flags) {
  SetupOptions& setup = flags.setup;
  verb.add_option("SCENE", setup.scene, "a glTF file (.gltf, .glb), or a generated scene: `gnomon scene` lists them")
      ->required();
  verb.add_option("--light", setup.light,
                  "NAME of a light of the scene, x,y,z in metres, or all (each in turn, and their sum); "
                  "default: the scene's first light that "
                  "the map can take, else one "
                  "above its centre (under the roof, where there is one)");
  verb.add_option("--camera", setup.camera,
                  "NAME of a camera of the scene, or eye:x,y,z,target:x,y,z[,fov:degrees] (vertical); "
                  "default: the scene's first "
                  "camera, else one that sees the scene");
  verb.add_option("--direction", setup.direction,
                  "x,y,z: the way the light shines, for spot and directional maps; default: the light's own "
                  "(spot, directional), "
                  "else (a point light) the mean direction of the surfaces in the picture that it lights");
  verb.add_option("--cone", setup.coneDegrees,
                  "full angle of the spot's cone, degrees; default: the light's own (spot), else 120. Pixels "
                  "outside are dark and "
                  "not scored");
  verb.add_option("--size", setup.size, "picture size: N or WxH, pixels")->capture_default_str();
  verb.add_option("--device", flags.device,
                  "part of a Vulkan device's name; default: a GPU where there is one, else the CPU device (lavapipe)");
  verb.add_option_function<std::string>(
      "--shader-dir", [](const std::string& folder) { gpu::setShaderDirectory(folder); },
      "read shaders from this folder instead of those built in, to edit them live");
  verb.add_flag_callback(
      "--quiet", [] { Progress::setQuiet(true); }, "no progress on the terminal");
}

Session openSession(const SceneFlags& flags) {
  return Session({.name = flags.device}, flags.setup);
}

}  // namespace gnomon
