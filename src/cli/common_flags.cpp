#include "cli/common_flags.h"

#include "base/error.h"
#include "base/progress.h"
#include "cli/verbs.h"
#include "gpu/shader_compiler.h"
#include "lab/core/maps.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

std::string typedCommand;

std::string quoted(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                          "_-+=.,:/%@") == std::string::npos;
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string knobFlag(const BiasMethod& method, const BiasKnob& knob) {
  return fmt::format("--{}-{}", method.name, knob.name);
}

std::string knobHelp(const BiasMethod& method, const BiasKnob& knob) {
  const std::string unit = *unitName(knob.unit) != '\0' ? fmt::format(" [{}]", unitName(knob.unit)) : "";
  return fmt::format("{}: {}{}; default {:g}{}", method.name, knob.sentence, unit, knob.defaultValue,
                     knob.defaultOfSceneScale ? " of the scene's diagonal" : "");
}

float checkedKnob(const std::string& flag, const BiasKnob& knob, float value) {
  if (!(value >= knob.lower && value <= knob.upper))
    throw UsageError(
        fmt::format("{} {:g} is outside {:g}..{:g} {}", flag, value, knob.lower, knob.upper, unitName(knob.unit)));
  return value;
}

std::string filterChoices() {
  std::string choices;
  for (const Filter& filter : filters())
    choices += fmt::format("{}{} ({})", choices.empty() ? "" : ", ", filter.name, filter.sentence);
  return choices;
}

void addUserBiases(const MethodFlags& flags, CompareOptions& options) {
  for (const std::string& path : flags.biasFiles) {
    options.userBiases.push_back(loadUserBias(path));
    const BiasMethod& method = options.userBiases.back()->method;
    for (const BiasMethod* other : options.biases)
      if (std::string_view(other->name) == method.name)
        throw UsageError(fmt::format("--bias-file {}: two biases are named '{}'; write //! name: in one of them", path,
                                     method.name));
    options.biases.push_back(&method);
    if (!flags.biasFileKnob) continue;
    if (method.knobs.empty())
      throw UsageError(fmt::format("--bias-file-knob: {} has no knob; write //! knob: in it", path));
    options.knobs.push_back(
        {&method.knobs.front(), checkedKnob("--bias-file-knob", method.knobs.front(), *flags.biasFileKnob)});
  }
  if (flags.biasFiles.empty() && flags.biasFileKnob) throw UsageError("--bias-file-knob needs a --bias-file");
}

void addFitFlags(CLI::App& verb, MethodFlags& flags) {
  verb.add_option("--fit", flags.fit,
                  "what spot and directional maps enclose. none: the whole cone or scene; tight: the camera's "
                  "frustum cut to the scene; focused: the surfaces the camera sees and the light faces")
      ->capture_default_str();
  verb.add_option("--snap", flags.snap,
                  "on: texels of spot and directional maps keep their places in the world while the camera "
                  "moves, for "
                  "up to 9% of the resolution; off: the window itself. Warped maps cannot snap")
      ->capture_default_str();
  verb.add_option("--warp", flags.warp,
                  "shape the texels of spot and directional maps to the camera: none, psm (perspective shadow maps), "
                  "lispsm (light space perspective) or tsm (trapezoidal)")
      ->capture_default_str();
  verb.add_option("--cascades", flags.cascades,
                  fmt::format("layers of a directional map, 1..{}, split by the practical scheme; not with --warp",
                              kMostCascades))
      ->capture_default_str();
}

// What means nothing on a map is left out there, and said so; where nothing is left, refused.
void checkMeaning(const CompareOptions& options, const Parameterization& map) {
  const CompareOptions own = optionsFor(options, map);
  std::string biases, left;
  for (const BiasMethod& method : biasMethods())
    if (map.supportsBias(method)) biases += (biases.empty() ? "" : ", ") + std::string(method.name);
  if (own.biases.empty())
    throw UsageError(fmt::format("--maps {} takes none of these --biases; choose from {}", map.name(), biases));
  if (own.filters.empty()) throw UsageError(fmt::format("--maps {} takes no filter; add --filters none", map.name()));
  for (const BiasMethod* bias : options.biases)
    if (std::ranges::find(own.biases, bias) == own.biases.end())
      left += (left.empty() ? "" : ", ") + std::string(bias->name);
  for (const Filter* filter : options.filters)
    if (std::ranges::find(own.filters, filter) == own.filters.end())
      left += (left.empty() ? "" : ", ") + std::string(filter->name);
  if (!left.empty()) fmt::print(stderr, "gnomon: {} has no depths to compare, so it leaves out {}\n", map.name(), left);
}

}  // namespace

void setCommandLine(int argc, char** argv) {
  typedCommand = "gnomon";
  for (int i = 1; i < argc; ++i) typedCommand += " " + quoted(argv[i]);
}

std::string commandLine() {
  return typedCommand;
}

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

void addVolumeFlags(CLI::App& verb, MethodFlags& flags) {
  verb.add_option("--vsv-size", flags.vsvSize, "voxels of a shadow volume, ALPHAxTHETAxPHI; PHI a multiple of 128")
      ->capture_default_str();
  verb.add_option("--vsv-source", flags.vsvSource,
                  "direct: each of a volume's columns meets the scene itself; resample: columns are looked up in a "
                  "cube map of side --map-size")
      ->capture_default_str();
  verb.add_option("--vsv-fit", flags.vsvFit, "frustum: a volume covers what the camera sees; full: the whole sphere")
      ->capture_default_str();
}

void addMethodFlags(CLI::App& verb, MethodFlags& flags, const char* defaultMaps, const char* defaultBiases) {
  flags.maps = defaultMaps;
  flags.biases = defaultBiases;
  std::string maps, biases;
  for (const Parameterization* map : parameterizations())
    maps += fmt::format("{}{} ({})", maps.empty() ? "" : ", ", map->name(), map->sentence());
  for (const BiasMethod& method : biasMethods()) biases += fmt::format("{}{}", biases.empty() ? "" : ", ", method.name);
  std::string sentences = "Biases:\n";
  for (const BiasMethod& method : biasMethods())
    sentences += fmt::format("  {:<17} {}\n", method.name, method.sentence);
  verb.footer(sentences);
  verb.add_option("--maps", flags.maps, "comma-separated: " + maps)->capture_default_str();
  verb.add_option("--biases", flags.biases, fmt::format("comma-separated, or all: {}", biases))->capture_default_str();
  verb.add_option("--bias-file", flags.biasFiles,
                  "GLSL file with a bias of your own, scored as one more row (docs/add_a_bias.md); may be repeated");
  verb.add_option("--bias-file-knob", flags.biasFileKnob,
                  "value of your bias's knob, in its unit; default: as the file says");
  verb.add_option("--filters", flags.filters, "comma-separated, or all: " + filterChoices())->capture_default_str();
  CLI::Option* side =
      verb.add_option("--map-size", flags.mapSize, "side of a map's layer, texels")->capture_default_str();
  verb.add_option("--map-texels", flags.mapTexels,
                  "texels of all layers together; picks the side, so that maps of different layer counts "
                  "compare fairly")
      ->excludes(side);
  verb.add_option("--cull", flags.cull,
                  "solids: closed one-sided meshes cast by their lit faces only; none: everything casts")
      ->capture_default_str();
  verb.add_option("--epsilon-at", flags.epsilonAt, "where adaptive takes its epsilon: fragment, occluder or stored")
      ->capture_default_str();
  verb.add_option("--cube-depth", flags.cubeDepth,
                  "hyperbolic: the rasterizer's depth of each face; radial: linear in the distance")
      ->capture_default_str();
  verb.add_option("--cube-passes", flags.cubePasses,
                  "six: a cube's faces are drawn one by one; multiview: in one pass; auto: whichever is faster "
                  "on the device, of what it draws right")
      ->capture_default_str();
  verb.add_option("--paraboloid-axis", flags.paraboloidAxis,
                  "x,y,z: where the first hemisphere looks; auto: the seam is turned away from what the camera sees")
      ->capture_default_str();
  verb.add_option("--paraboloid-raster", flags.paraboloidRaster,
                  "exact: each texel's ray decides; vertex: edges are drawn straight, which they are not; "
                  "tessellated: triangles are cut until that is right to half a texel")
      ->capture_default_str();
  addFitFlags(verb, flags);
  addVolumeFlags(verb, flags);
  for (const BiasMethod& method : biasMethods())
    for (const BiasKnob& knob : method.knobs)
      verb.add_option_function<float>(
          knobFlag(method, knob), [&flags, flag = knobFlag(method, knob)](float value) { flags.knobs[flag] = value; },
          knobHelp(method, knob));
}

CompareOptions compareOptions(const MethodFlags& flags) {
  CompareOptions options;
  options.maps = parseMaps(flags.maps);
  options.biases = parseBiases(flags.biases);
  options.filters = parseFilters(flags.filters);
  options.cull = parseCullMode(flags.cull);
  options.epsilonAt = parseEpsilonAt(flags.epsilonAt);
  options.mapOptions.cubeDepth = parseCubeDepth(flags.cubeDepth);
  options.mapOptions.cubePasses = parseCubePasses(flags.cubePasses);
  options.mapOptions.paraboloidRaster = parseParaboloidRaster(flags.paraboloidRaster);
  if (flags.paraboloidAxis != "auto") {
    const glm::vec3 axis = parseVec3("--paraboloid-axis", flags.paraboloidAxis);
    if (glm::length(axis) == 0.0f) throw UsageError("--paraboloid-axis 0,0,0 has no direction; write x,y,z or auto");
    options.mapOptions.paraboloidAxisW = glm::normalize(glm::dvec3(axis));
  }
  options.mapOptions.fit = parseWindowFit(flags.fit);
  options.mapOptions.snap = parseSnap(flags.snap);
  options.mapOptions.warp = parseWarp(flags.warp);
  options.mapOptions.cascades = flags.cascades;
  checkMapOptions(options.mapOptions);
  options.mapOptions.volumeSize = parseVolumeSize(flags.vsvSize);
  options.mapOptions.volumeSource = parseVolumeSource(flags.vsvSource);
  options.mapOptions.volumeFit = parseVolumeFit(flags.vsvFit);
  options.mapSide = flags.mapSize;
  options.mapTexels = flags.mapTexels;
  if (flags.mapTexels < 0) throw UsageError(fmt::format("--map-texels {}: must be positive", flags.mapTexels));
  for (const Parameterization* map : options.maps) mapSideOf(options, *map);
  for (const BiasMethod& method : biasMethods()) {
    for (const BiasKnob& knob : method.knobs) {
      const auto found = flags.knobs.find(knobFlag(method, knob));
      if (found == flags.knobs.end()) continue;
      options.knobs.push_back({&knob, checkedKnob(found->first, knob, found->second)});
    }
  }
  addUserBiases(flags, options);
  for (const Parameterization* map : options.maps) checkMeaning(options, *map);
  return options;
}

}  // namespace gnomon
