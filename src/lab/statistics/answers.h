#pragma once
// What a sweep says: each method's errors with intervals, who beats whom, what is Pareto-optimal, and where each method
// is worst; over all cases, and over those of a scene, a map, a size.

#include "lab/statistics/bootstrap.h"
#include "lab/statistics/measured_cases.h"

#include <string>
#include <vector>

namespace gnomon {

inline constexpr size_t kResamples = 1000;
inline constexpr uint64_t kBootstrapSeed = 1;
inline constexpr size_t kFewScenes = 5;  // with fewer, views are drawn in place of scenes

struct MethodAnswer {
  size_t method = 0;
  Estimates error;
  Estimate allWrong, biasError;                     // means
  std::optional<double> frameMs, buildMs, shadeMs;  // means, over the cases that were timed
  double texels = 0.0;                              // mean of the maps
};

// Of a scene, a map and a size; -1: all.
struct Subset {
  int scene = -1, map = -1, size = -1;
  size_t cases = 0;                   // of any method
  std::vector<MethodAnswer> methods;  // that have a case in it; the least mean error first
};

// Two methods on the cases that both have.
struct Pair {
  size_t a = 0, b = 0;  // methods; a's mean error is the smaller over all
  size_t cases = 0, aWins = 0, bWins = 0;
  Estimate difference;  // mean of b's error less a's
};

// A method on a map of a size, over all scenes.
struct ParetoPoint {
  size_t method = 0, map = 0, size = 0;
  double error = 0.0, texels = 0.0;
  std::optional<double> frameMs;
  bool leastTexels = false, leastTime = false;  // nothing that is as cheap has as small an error
};

struct WorstCase {
  size_t method = 0;
  double error = 0.0;
  std::string scene, light, camera, map, command, label;
  int mapSize = 0;
  std::string png;  // exact shadow and labels of its worst place; empty: not kept
};

struct Answers {
  CaseTable table;
  bool byScenes = true;  // groups of the bootstrap; else views
  size_t groups = 0;
  std::vector<Subset> subsets;  // first the whole
  std::vector<Pair> pairs;      // of the whole
  std::vector<ParetoPoint> pareto;
  std::vector<WorstCase> worst;  // ten a method

  const Subset& whole() const { return subsets.front(); }
  const Subset* find(int scene, int map, int size) const;
};

Answers answersOf(const Store& store, const CaseFilter& filter);

}  // namespace gnomon
