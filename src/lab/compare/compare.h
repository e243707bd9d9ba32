#pragma once
// `gnomon compare`: every chosen map with every chosen bias and filter, compared with the exact shadow pixel by pixel.

#include "lab/core/method.h"
#include "lab/results/comparison.h"
#include "shadow/user_bias.h"

#include <filesystem>
#include <functional>
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
  bool tune = false;                 // each method with a knob also at its best value, and how good that is elsewhere
  bool tuneElsewhere = true;         // the latter
  bool recommend = false;            // measure how good the best row that is not tuned is elsewhere
  std::optional<double> untilError;  // search each method's smallest map with at most this share of wrong pixels
  int untilMapSide = 4096;           // texels of a slice's side of the largest one tried
  std::string progressTitle = "compare";
  int repeats = 5;               // of every timed stage; at least 1
  std::filesystem::path outDir;  // empty: no pictures
  // Called after each map and light with what there is by then, whole but for `complete`.
  std::function<void(const Comparison&)> soFar;
};

// The options with the biases and filters that mean something on this map.
CompareOptions optionsFor(const CompareOptions& options, const Parameterization& map);

// "1024" texels a side, or a volume's "1024x1024x512" voxels.
std::string mapSizeText(const FittedMap& fitted);

// What the channels of a map take, or the bits of a volume.
size_t mapBytes(const FittedMap& fitted, ChannelSet channels);

// All but the head of results.json, of which the time of the G-buffer is there. Throws WorldError. Long work shows
// progress. Where it is interrupted (base/interrupt.h) the rows that are done are whole, and `complete` is false;
// Interrupted where there are none.
Comparison compare(const Session& session, const CompareOptions& options);

}  // namespace gnomon
