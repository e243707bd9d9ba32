#include "cli/scene_flags.h"

#include "base/progress.h"
#include "gpu/shader_compiler.h"
#include "judge/light_place.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

void addSceneFlags(CLI::App& verb, SceneFlags& flags) {
  SetupOptions& setup = flags.setup;
  verb.add_option("SCENE", setup.scene,
                  "a glTF file (.gltf, .glb), or the name of a generated scene (`gnomon scene` lists them)")
      ->required();
  verb.add_option(
      "--light", setup.light,
      "NAME of a light in the scene (or the end of its node's path, or #2), NAME@x,y,z (that light, moved), "
      "or a position x,y,z in metres, with the power of the scene's first lamp; compare and fog: or all (each "
      "light on its own, then their sum); default: the scene's first light that the map supports, else one above the "
      "scene's "
      "centre (below the roof, if there is one)");
  verb.add_option("--camera", setup.camera,
                  "NAME of a camera in the scene (or the end of its node's path, or #2), or "
                  "eye:x,y,z,target:x,y,z[,fov:degrees] (vertical); default: the "
                  "scene's first camera, else one that sees the whole scene");
  verb.add_option("--direction", setup.direction,
                  "x,y,z: direction in which the light shines, for spot and directional maps; default: the light's "
                  "own; for a point light, the mean direction to the visible surfaces that it lights");
  verb.add_option("--cone", setup.coneDegrees,
                  "full angle of the spot's cone, degrees; default: the spot light's own, else 120. Pixels outside "
                  "the cone are dark and not scored");
  verb.add_option("--intensity", setup.intensity, "candela, or lux of a directional light; default: the light's own");
  verb.add_option("--allow-path", setup.gltf.allowedFolders,
                  "a folder that the scene's buffers and images may lie in, beside the scene's own; may be repeated");
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
  Session session({.name = flags.device}, flags.setup);
  for (const std::string& note : session.scene().notes) fmt::print(stderr, "gnomon: note: {}\n", note);
  for (const Light& light : lightsAsked(flags.setup, session.tracer()))
    if (const std::optional<std::string> surface = surfaceThroughLight(session.scene(), light))
      fmt::print(
          stderr,
          "gnomon: note: light '{}' lies in the surface of '{}': rounding decides which side of it is dark; move "
          "it off, as with --light '{}@x,y,z'\n",
          light.name, *surface, light.name);
  return session;
}

}  // namespace gnomon
