#include "cli/scene_flags.h"

#include "base/error.h"
#include "base/progress.h"
#include "cli/choice.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "gpu/shader_compiler.h"
#include "judge/light_place.h"
#include "scene/generate.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const GeneratedScene& scene : generatedScenes()) names.emplace_back(scene.name);
  return names;
}

CLI::Option* addSceneFileFlags(CLI::App& verb, SetupOptions& setup) {
  CLI::Option* scene = verb.add_option(
      "SCENE", setup.scene, "a glTF file (.gltf, .glb), or the name of a generated scene (`gnomon scene` lists them)");
  offersFiles(scene, sceneNames());
  const OptionGroup group(verb, "Scene");
  verb.add_option("--scene-index", setup.gltf.scene,
                  "which of a file's scenes, counted from 0; default: the one that the file shows");
  offersOneOf(
      verb.add_option_function<std::string>(
              "--solids", [&setup](const std::string& name) { setup.choice.solids = parseSolids(name); },
              "which meshes are solids, whose back faces the map may leave out: file (closed, and not "
              "doubleSided), closed (all that are closed, whatever the file says: many exporters write "
              "doubleSided everywhere), auto (those, but for meshes that a light or a camera of the file stands in)")
          ->check(oneOf(solidsNames()))
          ->default_str(solidsName(SceneChoice().solids)),
      solidsNames());
  offersFolders(verb.add_option(
      "--allow-path", setup.gltf.allowedFolders,
      "a folder that the scene's buffers and images may lie in, beside the scene's own; may be repeated"));
  return scene;
}

void addSceneFlags(CLI::App& verb, SceneFlags& flags) {
  SetupOptions& setup = flags.setup;
  addSceneFileFlags(verb, setup)->required();
  {
    const OptionGroup group(verb, "Scene");
    verb.add_option("--casters", setup.choice.casters,
                    "NAME of a node or mesh, or a part of a node's path: only these cast shadows, the rest is seen and "
                    "receives them; may be repeated")
        ->allow_extra_args(false);
    verb.add_option("--exclude", setup.choice.excluded,
                    "NAME, as above, that casts no shadow: a lamp's own bulb; may be repeated")
        ->allow_extra_args(false);
    verb.add_option(
        "--light", setup.light,
        "NAME of a light in the scene (or the end of its node's path, or #2), NAME@x,y,z (that light, moved), "
        "or a position x,y,z in metres, with the power of the scene's first lamp; compare and fog: or all (each "
        "light on its own, then their sum); default: the scene's first light that the map supports, else one above the "
        "scene's "
        "centre (below the roof, if there is one)");
    verb.add_option("--direction", setup.direction,
                    "x,y,z: direction in which the light shines, for spot and directional maps; default: the light's "
                    "own; for a point light, the mean direction to the visible surfaces that it lights");
    verb.add_option(
        "--cone", setup.coneDegrees,
        "full angle of the spot's cone, degrees, up to 180; default: the spot light's own, else 120. Pixels "
        "outside the cone are dark and not scored");
    verb.add_option("--intensity", setup.intensity, "candela, or lux of a directional light; default: the light's own");
  }
  const OptionGroup group(verb, "View and device");
  verb.add_option("--camera", setup.camera,
                  "NAME of a camera in the scene (or the end of its node's path, or #2), or "
                  "eye:x,y,z,target:x,y,z[,fov:degrees] (vertical); default: the "
                  "scene's first camera, else one that sees the whole scene");
  verb.add_option("--size", setup.size,
                  fmt::format("picture size: N or WxH, pixels; the camera's vertical angle is kept; default: {} on the "
                              "longer side, in the aspect of the file's camera where that has one",
                              kDefaultSide));
  verb.add_option("--device", flags.device,
                  "part of a Vulkan device's name; default: a GPU if there is one, else the CPU device (lavapipe)");
  offersFolders(verb.add_option_function<std::string>(
      "--shader-dir", [](const std::string& folder) { gpu::setShaderDirectory(folder); },
      "read shaders from this folder instead of the built-in ones, to edit them without rebuilding"));
  verb.add_flag_callback(
      "--quiet", [] { Progress::setQuiet(true); }, "no progress display");
}

void addExposureFlag(CLI::App& verb, std::optional<float>& exposure) {
  verb.add_option_function<float>(
      "--exposure",
      [&exposure](float value) {
        if (!(value > 0.0f && value <= 1e12f))
          throw UsageError(fmt::format("--exposure {}: give a factor per cd/m^2, more than 0 and at most 1e12", value));
        exposure = value;
      },
      "factor from cd/m^2 to the picture's values, the same for several pictures; default: one that suits each, which "
      "is "
      "told");
}

void refuseAllLights(const SceneFlags& flags, const char* verb) {
  if (flags.setup.light == "all")
    throw UsageError(
        fmt::format("--light all: {} takes one light; name it, or a number as #0 (gnomon info {} lists them)", verb,
                    flags.setup.scene));
}

Session openSession(const SceneFlags& flags) {
  Session session({.name = flags.device}, flags.setup);
  for (const std::string& note : session.scene().notes) fmt::print(stderr, "gnomon: note: {}\n", note);
  const LightPlaces places(session.scene());
  for (const Light& light : lightsAsked(flags.setup, session.tracer()))
    if (const std::optional<std::string> surface = places.surfaceThrough(light))
      fmt::print(stderr,
                 "gnomon: note: light '{}' lies in the surface of '{}': rounding decides what of it is dark, on an "
                 "edge or a corner all; move "
                 "it off, as with --light '{}@x,y,z', or let that cast no shadow: --exclude '{}'\n",
                 light.name, *surface, light.name, *surface);
  return session;
}

}  // namespace gnomon
