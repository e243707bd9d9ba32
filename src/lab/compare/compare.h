#pragma once
// The main job: every chosen map with every chosen bias and filter, against the exact shadow, pixel by pixel.

#include "lab/core/method.h"
#include "lab/picture/unfold.h"
#include "lab/results/schema.h"
#include "shadow/user_bias.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

struct CompareOptions : MapChoice, KnobChoices {
  std::vector<const Parameterization*> maps;
  std::vector<const BiasMethod*> biases;
  std::vector<const Filter*> filters = {&gnomon::filters().front()};
  std::vector<std::shared_ptr<const UserBias>> userBiases;  // that `biases` names as well
  bool tune = false;          // each method with a knob also at its best value, and how good that is elsewhere
  bool tuneElsewhere = true;  // the latter
  std::string progressTitle = "compare";
  int repeats = 5;               // of every timed stage; at least 1
  std::filesystem::path outDir;  // empty: no pictures
};

// The options with the biases and filters that mean something on this map.
CompareOptions optionsFor(const CompareOptions& options, const Parameterization& map);

// "1024" texels a side, or a volume's "1024x1024x512" voxels.
std::string mapSizeText(const FittedMap& fitted);

// How good a tuned value is where it was not tuned.
struct Elsewhere {
  double biasError = 0.0;      // with the tuned value
  double bestBiasError = 0.0;  // with the value tuned there
  double bestValue = 0.0;
};

struct Tuning {
  std::string knob;  // the method's first
  double value = 0.0;
  std::string unit;
  int evaluations = 0;
  std::optional<Elsewhere> otherCamera;
  std::string otherCameraName;
  std::optional<Elsewhere> otherMapSize;
  int otherMapSide = 0;  // texels
};

// One method on one map through one filter. Counts are of the unfiltered map, and add up to `scored`.
struct Row {
  std::string map;
  std::string light;             // its name
  bool isSum = false;            // of the same method's rows over all lights: counts and times added, no pictures
  int mapSide = 0, mapRows = 0;  // texels along u and v of a layer
  int layers = 0;
  std::string mapSize;  // mapSizeText
  std::vector<MapParam> mapParams;
  std::string bias;
  std::vector<std::pair<std::string, double>> knobs;  // name -> value in its unit
  std::vector<std::string> knobUnits;
  std::string content;  // "one layer", "two layers", "back faces"
  std::string cull;
  std::string epsilonAt;  // empty where the method has none
  std::string filter = "none";
  size_t scored = 0, agree = 0, acne = 0, leak = 0, edgeShadow = 0, edgeLight = 0, uncovered = 0;
  size_t grazing = 0, edgeOn = 0;       // as in Judged
  double buildMs = 0.0, shadeMs = 0.0;  // medians, wall clock
  double biasError() const { return static_cast<double>(acne + leak) / static_cast<double>(scored); }
  // Of the visibility against the truth through the same filter, over the scored pixels. A pixel that the map
  // does not cover counts as predicted lit.
  double rmse = 0.0;
  // Mean FLIP of the shaded picture against the same by the truth; where any filter is asked for.
  std::optional<double> flip;
  std::optional<Tuning> tuning;  // of rows whose knobs were searched
  std::optional<WorstPlace> worstAcne, worstLeak;
  std::string command;  // that makes it again
  Pictures pictures;    // labels, visibility, beauty, difference, data
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

struct MapSummary {
  std::string map, light;
  int side = 0, rows = 0, layers = 0;  // texels along u and v
  float zNear = 0.0f, zFar = 0.0f;
  std::optional<SolidAngles> solidAngles;                        // of texels of maps that look around a point
  Pictures pictures;                                             // depth, second_depth, layer_gap, truth, ...
  std::vector<std::pair<std::string, Pictures>> filteredTruths;  // by filter: visibility, beauty
};

struct Comparison {
  std::vector<TruthSummary> truths;  // one a map
  std::vector<MapSummary> maps;
  std::vector<Row> rows;  // as they ran
  double gbufferMs = 0.0;
};

// Throws WorldError. Long work shows progress.
Comparison compare(const Session& session, const CompareOptions& options);

}  // namespace gnomon
