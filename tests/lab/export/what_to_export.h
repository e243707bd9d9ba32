#pragma once
// What tests of export choose from: maps, and the head of a bias of one's own.

#include "lab/export/export_shader.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "planar/planar_map.h"

#include <string>
#include <vector>

namespace gnomon::test {

struct Kind {
  const char* label;
  const char* name;
  bool radial;
  int cascades;
  const Parameterization& map;
  MapOptions options;
};

inline std::vector<Kind> kinds() {
  return {{"spot", "spot", false, 1, spotParameterization(), {}},
          {"cube", "cube", false, 1, cubeParameterization(), {}},
          {"paraboloid", "paraboloid", false, 1, paraboloidParameterization(), {}},
          {"directional", "directional", false, 1, directionalParameterization(), {}},
          {"cube, radial", "cube", true, 1, cubeParameterization(), {kCubeDepth(CubeDepth::Radial)}},
          {"cascades", "directional", false, 3, directionalParameterization(), {kCascades(3)}}};
}

inline ExportChoice choiceOf(const Kind& kind, const BiasMethod& bias, const Filter& filter, code::Language language) {
  ExportChoice choice;
  choice.map = exportedMap(kind.name, kind.radial, kind.cascades);
  choice.bias = &bias;
  choice.filter = &filter;
  choice.language = language;
  choice.command = "gnomon export";
  return choice;
}

inline bool mentions(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

inline constexpr const char* kUserHead = "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap)";

}  // namespace gnomon::test
