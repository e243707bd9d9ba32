#pragma once
// The list of biases: name, knobs with unit, range, default and a sentence. Flags, reports, --help and docs
// derive from it. The decisions themselves are in shaders/shared/bias/.

#include "shared/bias_params.glsl"

#include <string>
#include <vector>

namespace gnomon {

enum class Unit { Metres, Texels, One };
const char* unitName(Unit unit);  // "m", "texels", ""

struct BiasKnob {
  const char* name;  // on the command line --<bias>-<name>, in results params.<name>
  Unit unit;
  float lower, upper;
  // A default in metres would mean nothing on a scene of another size: metres are given as a share of the
  // scene's diagonal.
  float defaultValue;
  bool defaultOfSceneScale;
  const char* sentence;
  float glsl::BiasParams::*field;
  // Where a search for the best value looks, in the unit of the default (of the scene's diagonal, where that
  // is).
  float searchLower = 0.0f, searchUpper = 0.0f;
};

struct BiasMethod;
std::string knobFlag(const BiasMethod& method, const BiasKnob& knob);  // "--constant-offset"

// What a map must hold for a method.
enum class MapContent {
  OneLayer,   // the nearest depth
  TwoLayers,  // and the nearest behind it
  BackFaces,  // the nearest back face of solids, sheets as they are
};

const char* contentName(MapContent content);  // "one layer", "two layers", "back faces"

struct UserBias;

struct BiasMethod {
  int id;  // kBias*
  const char* name;
  const char* sentence;  // what it does and where it comes from
  std::vector<BiasKnob> knobs;
  MapContent content = MapContent::OneLayer;
  bool hasEpsilon = false;         // takes --epsilon-at
  const UserBias* user = nullptr;  // of --bias-file (user_bias.h)
};

// In the order they are listed and run.
const std::vector<BiasMethod>& biasMethods();

// A method's knobs; the three adaptive methods share one, which is adaptive's in the list.
const std::vector<BiasKnob>& knobsOf(const BiasMethod& method);

// Throws UsageError that lists the names.
const BiasMethod& findBias(const std::string& name);

// "a,b,c" or "all". Throws UsageError.
std::vector<const BiasMethod*> parseBiases(const std::string& list);

// Every knob at its default for a scene of this diagonal (metres).
glsl::BiasParams defaultBiasParams(float sceneScale);

// "fragment", "occluder", "stored". Throws UsageError.
int parseEpsilonAt(const std::string& name);
const char* epsilonAtName(int epsilonAt);

}  // namespace gnomon
