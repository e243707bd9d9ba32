#pragma once
// One readable, self-contained shader file of one map, bias and filter: the product's own visibility pass
// (shaders/shadow/unbound_visibility.glsl) with all that it does not need left out (simplify.h), printed in one of four
// languages (print_code.h), its parameters as named constants.

#include "lab/export/print_code.h"
#include "shadow/bias.h"
#include "shadow/filter.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

struct Scene;

// Numbers of a scene that a bias asks for.
struct ExportedScene {
  std::string name;
  float diagonal = 0.0f;   // metres
  float endMargin = 0.0f;  // metres (LookupTables)
  bool instanced = false;
  bool masked = false;
  uint32_t idShift = 0;
};
ExportedScene exportedScene(const Scene& scene);

struct ExportedMap {
  std::string name;  // "cube", "spot" ...
  int kind = 0;      // kMap*
  int sliceCount = 1;
  bool positional = true;  // the light is a point
  int side = 1024;         // texels
};

struct ExportChoice {
  ExportedMap map;
  const BiasMethod* bias = nullptr;
  const Filter* filter = nullptr;
  code::Language language = code::Language::Glsl;
  // Absent: of a scene of 10 m, which the file says.
  std::optional<ExportedScene> scene;
  std::map<const Knob*, float> knobs;           // that are not at their defaults
  glsl::BiasParams choices = defaultChoices();  // kEpsilonAt and so on
  std::string command;                          // by which it was made
};

// A texture or buffer that the file declares.
struct ExportedResource {
  std::string name;   // "gnomonDepth"
  int binding = 0;    // of GLSL and HLSL; the index of Metal's texture or buffer
  std::string holds;  // one sentence
};

struct ExportedShader {
  std::string text;
  std::vector<ExportedResource> resources;
};

// Throws UsageError where the choice makes no sense, with one line that says why; WorldError that names the file of a
// user's bias where that leaves the dialect of docs/shared_glsl.md.
ExportedShader exportShader(const ExportChoice& choice);
// In every language, in their order.
std::vector<ExportedShader> exportShaders(ExportChoice choice);

// What `--map NAME` stands for, with --cube-depth radial and --cascades. Throws UsageError: no such map, or one whose
// look-up is no shadow map's (vsv).
ExportedMap exportedMap(const std::string& name, bool radial, int cascades);

}  // namespace gnomon
