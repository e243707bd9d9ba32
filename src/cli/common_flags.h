#pragma once
// Flags that several verbs share. Knob flags derive from the list of biases (shadow/bias.h).

#include "lab/compare/compare.h"

#include <map>
#include <string>

namespace CLI {
class App;
}

namespace gnomon {

struct SceneFlags {
  SetupOptions setup;
  std::string device;
};
// SCENE, --light, --camera, --direction, --cone, --size, --device, --shader-dir, --quiet.
void addSceneFlags(CLI::App& verb, SceneFlags& flags);
// Applies --device: a session on the chosen scene.
Session openSession(const SceneFlags& flags);

struct MethodFlags {
  std::string maps;
  std::string biases;
  std::vector<std::string> biasFiles;
  std::vector<std::string> biasFileKnobs;  // NAME=VALUE or VALUE
  std::string filters = "none";
  int mapSize = 1024;
  long mapTexels = 0;
  std::string cull = "solids";
  std::string epsilonAt = "occluder";
  std::string cubeDepth = "hyperbolic";
  std::string cubePasses = "auto";
  std::string paraboloidAxis = "auto";
  std::string paraboloidRaster = "exact";
  std::string fit = "focused";
  std::string snap = "on";
  std::string warp = "none";
  int cascades = 1;
  std::string vsvSize = "1024x1024x512";
  std::string vsvSource = "direct";
  std::string vsvFit = "frustum";
  std::map<std::string, float> knobs;  // flag -> value
};
// --vsv-size, --vsv-source, --vsv-fit.
void addVolumeFlags(CLI::App& verb, MethodFlags& flags);
// --maps, --biases, --bias-file, --filters, --map-size, --map-texels, --cull, --epsilon-at, what concerns one
// kind of map only, and a flag a knob.
void addMethodFlags(CLI::App& verb, MethodFlags& flags, const char* defaultMaps, const char* defaultBiases);
// Throws UsageError.
CompareOptions compareOptions(const MethodFlags& flags);

// The command line as it was typed, quoted for a shell.
std::string commandLine();

}  // namespace gnomon
