#include "lab/bench/bench.h"

#include "base/check.h"
#include "base/error.h"
#include "base/progress.h"

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gnomon {

double processorMs() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

namespace {

// Of the same rounds.
double medianRatio(const std::vector<double>& times, const std::vector<double>& base) {
  std::vector<double> ratios;
  for (size_t round = 0; round < base.size(); ++round) ratios.push_back(times[round] / base[round]);
  return median(ratios);
}

}  // namespace

std::vector<StageCost> timeInRounds(const std::vector<TimedStage>& stages, int repeats) {
  GNOMON_CHECK(repeats >= 1);
  Progress progress("bench", repeats + 1);
  progress.step("first run of each stage");
  for (const TimedStage& stage : stages) stage.run();
  std::vector<std::vector<double>> times(stages.size()), cpuTimes(stages.size());
  for (int round = 0; round < repeats; ++round) {
    progress.step(fmt::format("round {} of {}", round + 1, repeats));
    for (size_t i = 0; i < stages.size(); ++i) {
      const double before = processorMs();
      times[i].push_back(stages[i].run());
      cpuTimes[i].push_back(processorMs() - before);
    }
  }
  std::map<std::string, size_t> indexOf;
  for (size_t i = 0; i < stages.size(); ++i) indexOf[stages[i].name] = i;
  std::vector<StageCost> costs;
  for (size_t i = 0; i < stages.size(); ++i) {
    const auto [least, most] = std::ranges::minmax(times[i]);
    StageCost cost{.name = stages[i].name,
                   .medianMs = median(times[i]),
                   .minMs = least,
                   .maxMs = most,
                   .ratioTo = stages[i].ratioTo,
                   .cpuMs = median(cpuTimes[i])};
    if (!cost.ratioTo.empty()) {
      const size_t base = indexOf.at(cost.ratioTo);
      cost.ratio = medianRatio(times[i], times[base]);
      cost.cpuRatio = medianRatio(cpuTimes[i], cpuTimes[base]);
    }
    costs.push_back(cost);
  }
  return costs;
}

std::vector<TimedStage> chosenStages(const std::vector<TimedStage>& stages, const std::vector<std::string>& words) {
  if (words.empty()) return stages;
  std::set<std::string> wanted;
  for (auto stage = stages.rbegin(); stage != stages.rend(); ++stage) {
    const bool named =
        std::ranges::any_of(words, [&](const std::string& w) { return stage->name.find(w) != std::string::npos; });
    if (!named && !wanted.contains(stage->name)) continue;
    wanted.insert(stage->name);
    wanted.insert(stage->ratioTo);
  }
  std::vector<TimedStage> chosen;
  for (const TimedStage& stage : stages)
    if (wanted.contains(stage.name)) chosen.push_back(stage);
  if (chosen.empty()) throw UsageError(fmt::format("--only {}: no stage has that in its name", fmt::join(words, ",")));
  return chosen;
}

namespace {

// A folder of its own that goes away with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "gnomon-bench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw fileError(name, "cannot be made", "set TMPDIR to a folder that can be written");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// This process's environment with some variables set anew.
std::vector<std::string> environmentWith(const std::map<std::string, std::string>& values) {
  std::vector<std::string> lines;
  for (char** line = ::environ; *line != nullptr; ++line) {
    const std::string text = *line;
    if (!values.contains(text.substr(0, text.find('=')))) lines.push_back(text);
  }
  for (const auto& [name, value] : values) lines.push_back(name + "=" + value);
  return lines;
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

double runOnce(std::vector<std::string> words, std::vector<std::string> environment) {
  const auto start = std::chrono::steady_clock::now();
  pid_t child = 0;
  const std::string program = words.front();
  posix_spawn_file_actions_t quiet;
  ::posix_spawn_file_actions_init(&quiet);
  ::posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const int failure =
      ::posix_spawn(&child, program.c_str(), &quiet, nullptr, pointersTo(words).data(), pointersTo(environment).data());
  ::posix_spawn_file_actions_destroy(&quiet);
  if (failure != 0) throw fileError(program, "cannot be run", "check that it is there and executable");
  int status = 0;
  ::waitpid(child, &status, 0);
  const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - start;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw WorldError(fmt::format("{} render: failed; run it by itself to see why", program));
  return passed.count();
}

}  // namespace

StartTimes measureStart(const std::filesystem::path& program, const SetupOptions& setup) {
  const ScratchFolder scratch;
  const std::string folder = scratch.path().string();
  std::vector<std::string> words = {program.string(), "render", "-o", folder + "/picture.png", "--quiet"};
  for (const std::string& word : setupWords(setup)) words.push_back(word);
  const std::vector<std::string> environment =
      environmentWith({{"GNOMON_CACHE_DIR", folder + "/shaders"}, {"MESA_SHADER_CACHE_DIR", folder + "/driver"}});
  StartTimes times;
  times.coldMs = runOnce(words, environment);
  std::vector<double> warm;
  for (int i = 0; i < 3; ++i) warm.push_back(runOnce(words, environment));
  times.warmMs = median(warm);
  return times;
}

Bench runBench(const Session& session, const gpu::DeviceOptions& device, const BenchOptions& options) {
  Bench bench;
  if (!options.program.empty()) bench.start = measureStart(options.program, session.setup());
  {
    const BenchStages stages(session, options);
    bench.stages = timeInRounds(chosenStages(stages.stages(), options.only), options.repeats);
  }
  if (options.growth) bench.growths = measureGrowth(session, device, options);
  return bench;
}

}  // namespace gnomon
