#pragma once
// A parameter of a bias or a filter, as their lists declare it. Flags, reports, --help and docs derive from it. The
// i-th in the list has its value in knobs[i] of glsl::BiasParams or glsl::FilterParams.

#include <string>

namespace gnomon {

enum class Unit { Metres, Texels, One };
const char* unitName(Unit unit);  // "m", "texels", ""

struct Knob {
  const char* name;  // on the command line --<bias>-<name>, in results params.<name>
  Unit unit;
  float lower, upper;
  // A default in metres would mean nothing on a scene of another size: metres are given as a share of the
  // scene's diagonal.
  float defaultValue;
  bool defaultOfSceneScale;
  const char* sentence;
  // Where a search for the best value looks, in the unit of the default (of the scene's diagonal, where that is).
  float searchLower = 0.0f, searchUpper = 0.0f;

  float defaultFor(float sceneScale) const { return defaultValue * (defaultOfSceneScale ? sceneScale : 1.0f); }
};

// "--constant-offset". `owner`: the name of the bias or filter that lists the knob; no two are named alike.
std::string knobFlag(const char* owner, const Knob& knob);

}  // namespace gnomon
