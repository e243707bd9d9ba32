#pragma once
// `gnomon bench`: timings of every stage, and how they scale.
//
// Machines are noisy, so all stages run once in each round, one after the other. A stage is reported as its ratio to
// another stage of the same round, the median over all rounds. Milliseconds are wall clock, from submission to the end
// of the wait.

#include "lab/core/method.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

// Processor time of all threads of this process so far, milliseconds.
double processorMs();

// A stage that can be run again and again.
struct TimedStage {
  std::string name;             // "map/cube/one layer"
  std::string ratioTo;          // the name of an earlier stage; empty: a limit of the machine
  std::function<double()> run;  // once; milliseconds
};

struct StageCost {
  std::string name;
  double medianMs = 0.0, minMs = 0.0, maxMs = 0.0;
  double ratio = 0.0;  // median over the rounds of this stage's time over ratioTo's; 0 where that is empty
  std::string ratioTo;
  // The same of the processor time of all threads: where the device is a CPU, what others do on the machine leaves it
  // as it is.
  double cpuMs = 0.0, cpuRatio = 0.0;
};

// Each stage once untimed, then `repeats` rounds of all.
std::vector<StageCost> timeInRounds(const std::vector<TimedStage>& stages, int repeats);

// The stages whose names hold one of the words, with those that they are compared with, in their order.
std::vector<TimedStage> chosenStages(const std::vector<TimedStage>& stages, const std::vector<std::string>& words);

// How the cost of some stages grows with one size.
struct Growth {
  std::string size;  // "triangles"
  std::string unit;  // what its numbers count
  std::vector<std::string> stages;
  struct Point {
    double size = 0.0;
    std::string name;           // "512 x 512 x 512"
    std::vector<double> ms;     // medians, one a stage
    std::vector<double> cpuMs;  // the same of the processor time of all threads; empty where it was not measured
  };
  std::vector<Point> points;  // by size
};

// From typing `gnomon render` to the picture, milliseconds; with every cache of shaders empty, and again.
struct StartTimes {
  double coldMs = 0.0, warmMs = 0.0;
};

struct BenchOptions {
  int64_t mapTexels = 6291456;  // of all slices of a map together
  MapOptions mapOptions;
  CullMode cull = CullMode::Solids;
  int repeats = 9;
  std::vector<std::string> only;  // words: stages whose names hold one, and what they are compared with; empty: all
  bool growth = true;
  int64_t mostTriangles = 10'000'000;  // of the growth with triangles
  std::filesystem::path program;       // gnomon itself, for the start; empty: not timed
};

struct Bench {
  std::vector<StageCost> stages;
  std::vector<Growth> growths;
  std::optional<StartTimes> start;
};

// Throws WorldError. Long work shows progress.
Bench runBench(const Session& session, const gpu::DeviceOptions& device, const BenchOptions& options);

// All stages of one session (bench_stages.cpp). What they run on lives as long as this does.
class BenchStages {
 public:
  BenchStages(const Session& session, const BenchOptions& options);
  ~BenchStages();
  const std::vector<TimedStage>& stages() const { return stages_; }

 private:
  struct Maps;
  void addLimits();
  void addFrame();
  void addGBufferAndTruth();
  void addMaps();
  void addVisibility();
  void addDecisions();
  void addVolumes();
  void addMedia();
  void add(std::string name, std::string ratioTo, std::function<double()> run);

  const Session& session_;
  const BenchOptions& options_;
  std::unique_ptr<Maps> maps_;
  std::vector<TimedStage> stages_;
};

std::vector<Growth> measureGrowth(const Session& session, const gpu::DeviceOptions& device,
                                  const BenchOptions& options);
StartTimes measureStart(const std::filesystem::path& program, const SetupOptions& setup);

std::string benchTable(const Session& session, const Bench& bench);
// {"gnomon": {...}, "scene": {...}, "stages": [{name, median_ms, min_ms, max_ms, cpu_ms, ratio, cpu_ratio, ratio_to}],
// "growth": [{size, unit, stages, exponents, cpu_exponents, points: [{size, name, ms, cpu_ms}]}], "start": {...}}
std::string benchJson(const Session& session, const Bench& bench, const std::string& command);
// The growths, milliseconds against size, both logarithmic: an SVG file's text. Empty where there are none.
std::string growthSvg(const std::vector<Growth>& growths);

}  // namespace gnomon
