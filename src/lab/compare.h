#pragma once
// The main job: every chosen map with every chosen bias, against the exact shadow, pixel by pixel.

#include "lab/session.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

struct KnobValue {
  const BiasKnob* knob = nullptr;
  float value = 0.0f;  // in the knob's unit
};

struct CompareOptions {
  std::vector<const Parameterization*> maps;
  std::vector<const BiasMethod*> biases;
  int mapSide = 1024;     // texels of a layer's side
  int64_t mapTexels = 0;  // of all layers together; not 0: picks each map's side instead of mapSide
  MapOptions mapOptions;
  CullMode cull = CullMode::Solids;
  int epsilonAt = glsl::kEpsilonAtOccluder;
  std::vector<KnobValue> knobs;  // that differ from their defaults
  int repeats = 5;               // of every timed stage; at least 1
  std::filesystem::path outDir;  // empty: no pictures
};

// The side of a map's layers, texels. Throws UsageError outside 2..16384.
int mapSideOf(const CompareOptions& options, const Parameterization& map);

// One method on one map. Counts add up to `scored`.
struct Row {
  std::string map;
  int mapSide = 0;
  int layers = 0;
  std::string bias;
  std::vector<std::pair<std::string, double>> knobs;  // name -> value in its unit
  std::vector<std::string> knobUnits;
  std::string content;  // "one layer", "two layers", "back faces"
  std::string cull;
  MapOptions mapOptions;  // as asked for: a spot has one cascade all the same
  std::string epsilonAt;  // empty where the method has none
  std::string filter = "none";
  size_t scored = 0, agree = 0, acne = 0, leak = 0, edgeShadow = 0, edgeLight = 0, uncovered = 0;
  size_t grazing = 0, edgeOn = 0;       // as in Judged
  double buildMs = 0.0, shadeMs = 0.0;  // medians, wall clock
  double biasError() const { return static_cast<double>(acne + leak) / static_cast<double>(scored); }
  // Of the binary visibility against the truth: the square root of the share of wrong pixels. A pixel that
  // the map does not cover counts as predicted lit.
  double rmse = 0.0;
  std::vector<std::string> pictures;  // below outDir
};

// What was exact for one map's light.
struct TruthSummary {
  std::string map;
  std::string lightName;
  LightModel light;
  size_t scored = 0, facingAway = 0, outsideCone = 0, lit = 0;
  size_t marginFlipsHalf = 0, marginFlipsDouble = 0;
  double margin = 0.0;              // metres
  float zNear = 0.0f, zFar = 0.0f;  // of the fitted map, metres
  std::string fitNote;              // FittedMap::note
  double receiversAndTraceMs = 0.0, fitMs = 0.0;
};

struct Comparison {
  std::vector<TruthSummary> truths;  // one a map
  std::vector<Row> rows;             // as they ran
  double gbufferMs = 0.0;
};

// Throws WorldError. Long work shows progress.
Comparison compare(const Session& session, const CompareOptions& options);

// Bias parameters of a session under these options.
glsl::BiasParams biasParams(const Session& session, const CompareOptions& options);

// Metres along each texel's ray to what the map stores; infinity where it stores nothing. Layers side by
// side.
ImageF depthInMetres(const Session& session, const DrawnMap& map);

double median(std::vector<double> values);

}  // namespace gnomon
