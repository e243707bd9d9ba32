#pragma once
// `gnomon sweep PLAN --slurm`: a job array of Slurm (https://slurm.schedmd.com), a shard a task, each with a store of
// its own in the folder STORE.slurm; and a job behind it that looks what is missing, submits that again, and merges.

#include "lab/store/store.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

inline constexpr int kMostSubmissions = 3;  // of a shard, before it is given up

struct SlurmRun {
  std::filesystem::path store;      // what the parts are merged into
  std::vector<std::string> words;   // the sweep's own: program, "sweep", PLAN and its flags; without store and shard
  std::vector<std::string> sbatch;  // for sbatch, of all jobs
  std::string planHash;             // what the parts must be of
  int shards = 1;
  int submission = 1;  // counts from 1

  std::filesystem::path folder() const { return store.string() + ".slurm"; }
  std::filesystem::path part(int shard) const;  // counts from 1
};

// The note in a store that says whether a shard of a plan is done.
std::string shardNote(const std::string& planHash, int shard, int shards);  // shards count from 1

// Submits those shards that are not done, and the job behind them. Returns the numbers of the two jobs. Throws
// WorldError: sbatch is not there, or refuses.
struct SlurmJobs {
  std::string array, collect;
  std::vector<int> shards;
};
SlurmJobs submitToSlurm(const SlurmRun& run);

// The shards that are not done.
std::vector<int> missingShards(const SlurmRun& run);

}  // namespace gnomon
