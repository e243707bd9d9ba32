#include "base/error.h"
#include "base/file.h"
#include "base/interrupt.h"
#include "base/message.h"
#include "base/progress.h"
#include "base/terminal.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "cli/unused_flags.h"
#include "cli/verbs.h"
#include "cli/version.h"
#include "cli/wrap.h"
#include "lab/statistics/answers_text.h"
#include "lab/store/content_hash.h"
#include "lab/sweep/benchmark.h"
#include "lab/sweep/slurm.h"
#include "lab/sweep/sweep.h"

#include <algorithm>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

namespace fs = std::filesystem;

constexpr const char* kBenchmark = "benchmark";
constexpr const char* kMerge = "merge";
constexpr const char* kNoCase = "the plan has no case: what it excludes is everything";

struct SweepFlags {
  const CLI::App* verb = nullptr;
  std::vector<std::string> words;  // PLAN, or benchmark, or merge PART...
  std::string db, out, shard, device;
  std::vector<std::string> scenes, biasFiles, sbatch;
  bool dryRun = false, quick = false, slurm = false;
  int shards = 4, submission = 0;
};

bool isBenchmark(const SweepFlags& flags) {
  return flags.words.front() == kBenchmark;
}

Plan planOf(const SweepFlags& flags) {
  return isBenchmark(flags) ? benchmarkPlan(flags.quick) : readPlan(flags.words.front());
}

fs::path storeOf(const SweepFlags& flags) {
  if (!flags.db.empty()) return flags.db;
  if (isBenchmark(flags)) return flags.quick ? "benchmark-quick.db" : "benchmark.db";
  return fs::path(flags.words.front()).filename().replace_extension(".db");
}

// "2/8" to 1 and 8.
std::pair<int, int> parseShard(const std::string& text) {
  int shard = 0, shards = 0;
  const bool isRead = std::sscanf(text.c_str(), "%9d/%9d", &shard, &shards) == 2;
  // No sign, no blank, nothing behind.
  if (!isRead || fmt::format("{}/{}", shard, shards) != text || shard < 1 || shards < shard)
    throw UsageError(fmt::format("--shard {}: write which of how many, as in 2/8", text));
  return {shard - 1, shards};
}

std::string durationText(double seconds) {
  if (seconds < 100.0) return fmt::format("{:.1f} s", seconds);
  if (seconds < 6000.0) return fmt::format("{:.1f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

void sayFound(const std::vector<std::string>& lines, const char* kind) {
  constexpr size_t kMost = 20;
  for (size_t i = 0; i < std::min(lines.size(), kMost); ++i)
    std::fprintf(stderr, "gnomon: %s: %s\n", kind, printable(lines[i]).c_str());
  if (lines.size() > kMost) std::fprintf(stderr, "gnomon: %s: and %zu more\n", kind, lines.size() - kMost);
}

// 1 where there are conflicts.
int sayMerged(const MergeReport& report) {
  sayFound(report.replaced, "note");
  sayFound(report.mixtures, "note");
  sayFound(report.conflicts, "conflict");
  if (report.conflicts.empty()) return 0;
  std::fprintf(stderr,
               "gnomon: %zu conflicts: the same case, method, version of results and device, and other counts; the "
               "first store's are kept\n",
               report.conflicts.size());
  return 1;
}

int runMerge(const SweepFlags& flags) {
  if (flags.words.size() < 2) throw UsageError("merge: name the stores to merge, as in part*.db");
  if (flags.out.empty()) throw UsageError("merge: name the store to write, with -o all.db");
  if (fs::is_regular_file(flags.out))
    throw fileError(flags.out, "exists",
                    "write a store of a new name; to keep its rows, name it among the stores to merge, too");
  const std::vector<fs::path> parts(flags.words.begin() + 1, flags.words.end());
  const MergeReport report = mergeStores(parts, flags.out);
  say(fmt::format("wrote {}: {} rows of {} in {} stores{}\n", flags.out, report.added, report.rows, parts.size(),
                  report.superseded > 0 ? fmt::format("; {} are superseded", report.superseded) : ""));
  return sayMerged(report);
}

int runDry(const SweepFlags& flags, const Plan& plan, const Axes& axes, const SweepOptions& options) {
  std::unique_ptr<Store> store;
  const fs::path path = storeOf(flags);
  if (isStoreThere(path)) store = std::make_unique<Store>(path, sql::Open::Existing);
  const SweepEstimate estimate = estimateSweep(plan, axes, store.get(), options);
  if (estimate.cases == 0 && options.shards == 1) throw UsageError(kNoCase);
  say(fmt::format(
      "{} scenes, {} views (a camera and a light), {} cases (a map of one size), {} rows (a method and filter)\n",
      estimate.scenes, estimate.views, estimate.cases, estimate.rows));
  if (estimate.before) say(fmt::format("{} rows are in {}\n", *estimate.before, storeOf(flags).string()));
  say(fmt::format("about {} for what is missing, by {} cases that were tried; {:.0f} MiB of memory at most by then\n",
                  durationText(estimate.seconds), estimate.tried, estimate.peakBytes / (1 << 20)));
  return 0;
}

SlurmRun slurmRunOf(const SweepFlags& flags, const std::string& planHash) {
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);
  SlurmRun run{.store = storeOf(flags), .sbatch = flags.sbatch, .planHash = planHash, .shards = flags.shards};
  run.words = {failure ? "gnomon" : program.string(), "sweep"};
  run.words.push_back(isBenchmark(flags) ? kBenchmark : fs::absolute(flags.words.front()).string());
  if (flags.quick) run.words.push_back("--quick");
  for (const std::string& folder : flags.scenes)
    run.words.insert(run.words.end(), {"--scenes", fs::absolute(folder).string()});
  for (const std::string& file : flags.biasFiles)
    run.words.insert(run.words.end(), {"--bias-file", fs::absolute(file).string()});
  if (!flags.device.empty()) run.words.insert(run.words.end(), {"--device", flags.device});
  return run;
}

void saySubmitted(const SlurmRun& run, const SlurmJobs& jobs) {
  if (!jobs.array.empty())
    say(fmt::format("submitted job {}: shards {} of {}\n", jobs.array, fmt::join(jobs.shards, ","), run.shards));
  say(fmt::format("submitted job {}: submits what fails again, and merges into {}; logs are in {}\n", jobs.collect,
                  run.store.string(), run.folder().string()));
}

// After the array: what is missing once more, or the merge.
int runCollect(const SweepFlags& flags, const std::string& planHash) {
  SlurmRun run = slurmRunOf(flags, planHash);
  run.submission = flags.submission;
  const std::vector<int> missing = missingShards(run);
  if (!missing.empty() && run.submission < kMostSubmissions) {
    std::fprintf(stderr, "gnomon: shards %s are not done\n", fmt::format("{}", fmt::join(missing, ",")).c_str());
    ++run.submission;
    saySubmitted(run, submitToSlurm(run));
    return 0;
  }
  std::vector<fs::path> parts;
  if (isStoreThere(run.store)) parts.push_back(run.store);
  for (int shard = 1; shard <= run.shards; ++shard)
    if (isStoreThere(run.part(shard))) parts.push_back(run.part(shard));
  if (parts.empty())
    throw WorldError(fmt::format("no shard wrote anything; see the logs in {}", run.folder().string()));
  const MergeReport report = mergeStores(parts, run.store);
  say(fmt::format("wrote {}: {} rows\n", run.store.string(), report.added));
  const int exitCode = sayMerged(report);
  if (missing.empty()) return exitCode;
  std::fprintf(stderr, "gnomon: shards %s failed %d times; see the logs in %s\n",
               fmt::format("{}", fmt::join(missing, ",")).c_str(), kMostSubmissions, run.folder().string().c_str());
  return 1;
}

int runSlurm(const SweepFlags& flags, const std::string& planHash) {
  if (flags.submission > 0) return runCollect(flags, planHash);
  const SlurmRun run = slurmRunOf(flags, planHash);
  saySubmitted(run, submitToSlurm(run));
  return 0;
}

void sayOutcome(const SweepOutcome& outcome, const fs::path& store) {
  say(fmt::format("{}: {} rows, {} of them from before; {} rows of {} cases measured in {}\n", store.string(),
                  outcome.rows, outcome.before, outcome.measured, outcome.cases, durationText(outcome.seconds)));
  if (outcome.measured > 0) {
    std::string stages;
    for (const auto& [name, seconds] : outcome.stages)
      if (seconds > 0.005 * outcome.seconds)
        stages += fmt::format("{}{} {:.0f}%", stages.empty() ? "" : ", ", name, 100.0 * seconds / outcome.seconds);
    say(fmt::format("{:.0f} rows a minute: {}\n", 60.0 * static_cast<double>(outcome.measured) / outcome.seconds,
                    stages));
  }
  if (outcome.empty > 0)
    say(fmt::format("{} cases light nothing that their camera sees, and are left out from now on\n", outcome.empty));
  if (outcome.elsewhere > 0) say(fmt::format("{} rows are being measured by another process\n", outcome.elsewhere));
}

// Where a person's own biases came out.
void sayOwnPlaces(const Answers& answers, const Axes& axes) {
  const std::vector<MethodAnswer>& ranked = answers.whole().methods;
  for (size_t i = 0; i < ranked.size(); ++i) {
    const std::string& name = answers.table.methods[ranked[i].method];
    const bool isOwn = std::ranges::any_of(
        axes.methods, [&](const SweepMethod& method) { return method.user != nullptr && method.label == name; });
    if (isOwn)
      say(fmt::format("\n{}: place {} of {}, by its mean {} of {}%\n", name, i + 1, ranked.size(),
                      errorName(answers.table.by), perCentOf(ranked[i].error.mean.value)));
  }
}

int runPlan(const SweepFlags& flags, const Plan& plan, const Axes& axes, const SweepOptions& options) {
  const InterruptGuard guard;
  if (flags.dryRun) return runDry(flags, plan, axes, options);
  const fs::path path = storeOf(flags);
  const bool isNew = !fs::exists(path);
  SweepOutcome outcome;
  {
    Store store(path, sql::Open::Create);
    outcome = runSweep(plan, axes, store, options);
  }
  if (outcome.rows == 0 && outcome.empty == 0 && options.shards == 1 && !outcome.isInterrupted) {
    if (isNew) fs::remove(path);
    throw UsageError(kNoCase);
  }
  sayOutcome(outcome, path);
  if (outcome.isInterrupted) {
    std::fprintf(stderr, "gnomon: interrupted; the same command goes on from here\n");
    return kInterruptedExitCode;
  }
  if (options.shards == 1 && outcome.rows > 0 && outcome.elsewhere == 0 && !axes.methods.empty()) {
    const Answers answers = answersOf(Store(path, sql::Open::ReadOnly), {});
    say("\n" + rankingText(answers, terminalWidth()) + howIntervals(answers) + "\n");
    sayOwnPlaces(answers, axes);
    say(fmt::format("\ngnomon report {} -o page.html shows the rest\n", path.string()));
  }
  if (outcome.failed == 0) return 0;
  std::fprintf(stderr, "gnomon: %zu cases failed (table failure of %s); the first: %s\n", outcome.failed, path.c_str(),
               outcome.firstFailure.c_str());
  return 1;
}

// Each flag with what it is for.
void refuseUnusedFlags(const SweepFlags& flags) {
  const UnusedFlags unused(*flags.verb);
  const bool isMerge = flags.words.front() == kMerge;
  for (const char* flag : {"--db", "--shard", "--device", "--scenes", "--bias-file", "--sbatch", "--dry-run", "--quick",
                           "--slurm", "--shards", "--slurm-collect"})
    unused.refuseUnless(!isMerge, flag, "merge takes stores and -o, and no other flag");
  unused.refuseUnless(isMerge, "--out", "only merge writes a file of that name; the store is --db FILE");
  unused.refuseUnless(isBenchmark(flags), "--quick", "it is for gnomon sweep benchmark");
  for (const char* flag : {"--shards", "--sbatch", "--slurm-collect"})
    unused.refuseUnless(flags.slurm, flag, "it is for --slurm; a shard by hand is --shard 2/8");
  for (const char* flag : {"--shard", "--dry-run"})
    unused.refuseUnless(!flags.slurm, flag, "--slurm makes shards of its own, and submits them");
}

int runSweepVerb(const SweepFlags& flags) {
  refuseUnusedFlags(flags);
  if (flags.words.front() == kMerge) return runMerge(flags);
  if (flags.words.size() > 1)
    throw UsageError(fmt::format("{}: one word too many (see gnomon sweep --help)", flags.words[1]));
  SweepOptions options{.device = {.name = flags.device}, .program = programText()};
  if (!flags.shard.empty()) std::tie(options.shard, options.shards) = parseShard(flags.shard);
  const Plan plan = planOf(flags);
  const Axes axes = axesOf(plan, flags.scenes, flags.biasFiles);
  std::string everything = plan.text;
  for (const std::string& word : flags.scenes) everything += "\nscenes " + word;
  for (const std::string& word : flags.biasFiles) everything += "\nbias " + readFile(word);
  options.planHash = hashOf(everything).substr(0, 16);
  return flags.slurm ? runSlurm(flags, options.planHash) : runPlan(flags, plan, axes, options);
}

Run addSweep(CLI::App* verb) {
  auto flags = std::make_shared<SweepFlags>();
  flags->verb = verb;
  offersFiles(
      verb->add_option("PLAN", flags->words,
                       "a plan (docs/sweep.md); or benchmark, the frozen plan behind docs/findings.md; or merge "
                       "PART.db..., which makes one store of several")
          ->required(),
      {kBenchmark, kMerge});
  {
    const OptionGroup group(*verb, "Plan");
    offersFolders(verb->add_option("--scenes", flags->scenes,
                                   "a folder whose .gltf and .glb files are scenes, too; may be repeated")
                      ->allow_extra_args(false));
    offersFiles(verb->add_option("--bias-file", flags->biasFiles,
                                 "GLSL file with your own bias, one more method; may be repeated")
                    ->allow_extra_args(false));
    verb->add_flag("--quick", flags->quick, "of the benchmark a small share, for a few minutes");
    verb->add_flag(
        "--dry-run", flags->dryRun,
        "measure nothing but a few cases, and say how many there are, how long they take and how much memory");
  }
  {
    const OptionGroup group(*verb, "Store and machines");
    offersFiles(verb->add_option("--db", flags->db,
                                 "the store: a SQLite file, made or gone on with; default: the plan's name with .db"));
    verb->add_option(
        "--shard", flags->shard,
        "i/n: of each n views in turn one, another place of them each time, for n machines with a store each");
    verb->add_flag("--slurm", flags->slurm,
                   "submit the shards as a job array of Slurm, and a job that submits again what fails and merges");
    verb->add_option("--shards", flags->shards, "how many, of --slurm")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    verb->add_option("--sbatch", flags->sbatch, "a flag for sbatch, as in --sbatch=--partition=long; may be repeated")
        ->allow_extra_args(false);
    verb->add_option("--slurm-collect", flags->submission,
                     "for the job that --slurm itself submits: what fails is submitted again, the stores are merged")
        ->check(CLI::Range(1, kMostSubmissions))
        ->group("");
    offersFiles(verb->add_option("-o,--out", flags->out, "of merge: the store to write"));
    verb->add_option("--device", flags->device,
                     "part of a Vulkan device's name; default: a GPU if there is one, else the CPU device (lavapipe)");
    verb->add_flag_callback(
        "--quiet", [] { Progress::setQuiet(true); }, "no progress display");
  }
  return [flags] { return runSweepVerb(*flags); };
}

}  // namespace

Verb sweepVerb() {
  return {.name = "sweep",
          .sentence = "measures a plan of many scenes, lights, cameras, maps and biases into a store, with statistics",
          .add = addSweep};
}

}  // namespace gnomon
