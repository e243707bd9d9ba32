#pragma once
// `gnomon sweep`: every case of a plan, measured once and stored. Cases that share a scene, a picture, a ground
// truth or a map share them here, too.

#include "gpu/device.h"
#include "lab/store/store.h"
#include "lab/sweep/survey.h"

#include <map>
#include <string>

namespace gnomon {

// How isInShard() divides the views; another word when it divides them otherwise, since a part that was done as another
// division has it is not done as this one has it.
inline constexpr const char* kShardDivision = "in turns";

struct SweepOptions {
  gpu::DeviceOptions device;
  std::string program;        // what the program says it is, in rows
  std::string planHash;       // of the plan and what was added to it, for the store's note of a shard that is done
  int shard = 0, shards = 1;  // of the views (isInShard)

  // Of each `shards` views in turn one, another place of them each time: views of one map may be every second one.
  bool isInShard(size_t view) const {
    const auto count = static_cast<size_t>(shards);
    return (view + view / count) % count == static_cast<size_t>(shard);
  }
};

// Where the time went, by name: seconds of wall clock.
using Stages = std::vector<std::pair<std::string, double>>;

struct SweepOutcome {
  size_t rows = 0;       // of the plan (of this shard)
  size_t before = 0;     // that were there
  size_t measured = 0;   // now
  size_t cases = 0;      // that these are of: scene, camera, light, map and size
  size_t empty = 0;      // cases where no pixel faces the light
  size_t failed = 0;     // cases, whose complaints are in the store
  size_t elsewhere = 0;  // rows that another process had claimed
  double seconds = 0.0;
  Stages stages;
  std::string firstFailure;
  bool isInterrupted = false;
};

// Throws WorldError. Where it is interrupted all cases but the one in flight are stored.
SweepOutcome runSweep(const Plan& plan, const Axes& axes, Store& store, const SweepOptions& options);

struct SweepEstimate {
  size_t scenes = 0, views = 0, cases = 0, rows = 0;
  std::optional<size_t> before;  // rows that are there already
  double seconds = 0.0;          // of what is missing, by the cases that were tried
  size_t tried = 0;              // cases
  double peakBytes = 0.0;        // of memory
};
// Measures a few cases of the plan's maps and scenes, and stores nothing of them (estimate.h). `store` may be null.
SweepEstimate estimateSweep(const Plan& plan, const Axes& axes, Store* store, const SweepOptions& options);

}  // namespace gnomon
