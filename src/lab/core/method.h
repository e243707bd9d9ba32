#pragma once
// The choices for a map and for a bias, and what follows from them: the map's side, the bias with its parameters set.

#include "lab/core/session.h"

#include <vector>

namespace gnomon {

struct MapChoice {
  int mapSide = 1024;     // texels of a slice's side
  int64_t mapTexels = 0;  // of all slices together; not 0: picks each map's side instead of mapSide
  MapOptions mapOptions;
  CullMode cull = CullMode::Solids;
  std::optional<float> exposure;  // of pictures, per cd/m^2; absent: chosen for each
};

// The side of a map's slices, texels. Throws UsageError outside 2..16384.
int mapSideOf(const MapChoice& choice, const Parameterization& map);
MapSetup mapSetupOf(const MapChoice& choice, const Parameterization& map);

struct KnobValue {
  const Knob* knob = nullptr;
  float value = 0.0f;  // in the knob's unit
};

struct KnobChoices {
  glsl::BiasParams choices = defaultChoices();  // its knobs stand for nothing
  std::vector<KnobValue> knobs;                 // that differ from their defaults
};

// A bias or a filter with its knobs as chosen, else at their defaults.
Method methodFor(const SceneView& view, const KnobChoices& choices, const BiasMethod& bias);
ChosenFilter filterFor(const KnobChoices& choices, const Filter& filter);

double median(std::vector<double> values);

}  // namespace gnomon
