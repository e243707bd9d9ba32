#include "lab/sweep/slurm.h"

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/parse.h"
#include "lab/sweep/sweep.h"

#include <sys/wait.h>

#include <array>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

constexpr const char* kShardScript = "shard.sh";
constexpr const char* kCollectScript = "collect.sh";

std::string commandOf(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shellWord(word);
  return line;
}

// Its last line on standard output: sbatch may be wrapped by a site's own, which greets.
std::string jobNumberFrom(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw WorldError("sbatch cannot be started: out of processes or memory");
  std::string text;
  std::array<char, 512> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) text += buffer.data();
  const int status = ::pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw WorldError("--slurm: sbatch is not installed here; run this where jobs are submitted (Debian: slurm-client)");
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  std::string last = text.substr(text.find_last_of('\n') == std::string::npos ? 0 : text.find_last_of('\n') + 1);
  last = last.substr(0, last.find(';'));  // "number;cluster"
  if (status != 0 || last.empty() || last.find_first_not_of("0123456789") != std::string::npos)
    throw WorldError(fmt::format("sbatch refused the job: {}; give what it needs with --sbatch", oneLine(text, 200)));
  return last;
}

std::string sbatch(const SlurmRun& run, const std::vector<std::string>& own, const fs::path& script) {
  std::vector<std::string> words = {"sbatch", "--parsable"};
  words.insert(words.end(), run.sbatch.begin(), run.sbatch.end());
  words.insert(words.end(), own.begin(), own.end());
  words.push_back(script.string());
  return jobNumberFrom(commandOf(words));
}

// What a submission writes before sbatch is asked; gone again where nothing was submitted.
class Preparations {
 public:
  explicit Preparations(const fs::path& folder) {
    for (fs::path at = folder; !at.empty() && !fs::exists(at) && at != at.parent_path(); at = at.parent_path())
      made_.push_back(at);
  }
  ~Preparations() {
    if (isKept_ || made_.empty()) return;
    std::error_code failure;
    for (const char* script : {kShardScript, kCollectScript}) fs::remove(made_.front() / script, failure);
    for (const fs::path& folder : made_) fs::remove(folder, failure);  // where it is empty
  }
  Preparations(const Preparations&) = delete;
  Preparations& operator=(const Preparations&) = delete;
  void keep() { isKept_ = true; }

 private:
  std::vector<fs::path> made_;  // folders that were not there, the innermost first
  bool isKept_ = false;
};

}  // namespace

std::filesystem::path SlurmRun::part(int shard) const {
  return folder() / fmt::format("part-{}.db", shard);
}

std::string shardNote(const std::string& planHash, int shard, int shards) {
  return fmt::format("shard {}/{} of {}, divided {}", shard, shards, planHash, kShardDivision);
}

std::vector<int> missingShards(const SlurmRun& run) {
  std::vector<int> missing;
  for (int shard = 1; shard <= run.shards; ++shard) {
    bool isDone = false;
    try {
      isDone = fs::exists(run.part(shard)) &&
               Store(run.part(shard), sql::Open::ReadOnly).note(shardNote(run.planHash, shard, run.shards)) == "done";
    } catch (const WorldError&) {  // what is damaged is not done
    }
    if (!isDone) missing.push_back(shard);
  }
  return missing;
}

SlurmJobs submitToSlurm(const SlurmRun& run) {
  const fs::path store = fs::absolute(run.store);
  checkOutput(store);
  if (isStoreThere(store)) Store(store, sql::Open::ReadOnly);  // that it can be merged with
  const fs::path folder = fs::absolute(run.folder());
  Preparations preparations(folder);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw fileError(folder.string(), failure.message(), "name a --db in a folder that can be written");
  SlurmJobs jobs{.array = {}, .collect = {}, .shards = missingShards(run)};
  const std::string words = commandOf(run.words);
  std::vector<std::string> dependency;
  if (!jobs.shards.empty()) {
    const fs::path script = folder / kShardScript;
    writeTextFile(script,
                  fmt::format("#!/bin/sh\n# A shard of the sweep: made by gnomon sweep --slurm.\nexec {} --quiet "
                              "--shard \"$SLURM_ARRAY_TASK_ID/{}\" --db {}/part-\"$SLURM_ARRAY_TASK_ID\".db\n",
                              words, run.shards, shellWord(folder.string())));
    jobs.array = sbatch(run,
                        {"--job-name=gnomon-sweep", fmt::format("--array={}", fmt::join(jobs.shards, ",")),
                         "--output=" + (folder / "shard-%a.log").string(), "--open-mode=append"},
                        script);
    preparations.keep();  // the array's jobs run in it
    dependency = {"--dependency=afterany:" + jobs.array};
  }
  const fs::path script = folder / kCollectScript;
  std::string sbatchWords;
  for (const std::string& word : run.sbatch) sbatchWords += " --sbatch=" + shellWord(word);
  writeTextFile(script,
                fmt::format("#!/bin/sh\n# Submits again what is missing, else merges: made by gnomon sweep --slurm.\n"
                            "exec {} --quiet --slurm --shards {} --slurm-collect {}{} --db {}\n",
                            words, run.shards, run.submission, sbatchWords, shellWord(store.string())));
  std::vector<std::string> own = {"--job-name=gnomon-collect", "--output=" + (folder / "collect.log").string(),
                                  "--open-mode=append"};
  own.insert(own.end(), dependency.begin(), dependency.end());
  jobs.collect = sbatch(run, own, script);
  preparations.keep();
  return jobs;
}

}  // namespace gnomon
