#include "lab/sweep/sweep.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/message.h"
#include "base/progress.h"
#include "lab/sweep/measure.h"
#include "lab/sweep/slurm.h"

#include <algorithm>
#include <new>

#include <fmt/format.h>

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

// What fails without end is no matter of a case: a device that is lost, memory that others took.
constexpr size_t kMostFailuresInARow = 20;

double secondsSince(Clock::time_point begun) {
  return std::chrono::duration<double>(Clock::now() - begun).count();
}

// Of each method the largest bias errors so far, of which pictures are kept. What other processes on the store add is
// not seen: then there are pictures too many for a while (Store::keepWorstPictures).
class WorstErrors {
 public:
  void start(const Store& store, int perMethod) {
    most_ = static_cast<size_t>(perMethod);
    errors_ = store.worstErrors(perMethod);
  }
  // The error from which on a case is among them; above what an error can be where none are kept.
  double least(const std::string& method) const {
    if (most_ == 0) return 2.0;
    const auto found = errors_.find(method);
    return found == errors_.end() || found->second.size() < most_ ? 0.0 : found->second.back();
  }
  void add(const std::string& method, double error) {
    std::vector<double>& errors = errors_[method];
    errors.insert(std::ranges::upper_bound(errors, error, std::greater()), error);
    if (errors.size() > most_) errors.pop_back();
  }

 private:
  size_t most_ = 0;
  std::map<std::string, std::vector<double>> errors_;  // the largest first
};

class Runner {
 public:
  Runner(const Plan& plan, const Axes& axes, Store& store, const SweepOptions& options)
      : plan_(plan), axes_(axes), store_(store), options_(options), device_(gpu::Device::create(options.device)) {}

  SweepOutcome run() {
    const Clock::time_point begun = Clock::now();
    machine_ = machineOf(*device_, options_);
    store_.startWork(machine_);
    if (!plan_.name.empty()) store_.setNote("name", plan_.name);
    store_.setNote(kWorstPicturesNote, std::to_string(plan_.worstPictures));
    worst_.start(store_, plan_.worstPictures);
    const std::string note = shardNote(options_.planHash, options_.shard + 1, options_.shards);
    store_.setNote(note, "not done");
    try {
      const Survey survey = surveyed();
      measurer_ = std::make_unique<SweepMeasurer>(plan_, axes_, survey, device_, clock_);
      runViews(survey);
    } catch (const Interrupted&) {
    }
    outcome_.isInterrupted = isInterrupted();
    if (plan_.worstPictures > 0) {
      const auto running = clock_.run("store");
      store_.keepWorstPictures(plan_.worstPictures);
    }
    const bool isWhole = !outcome_.isInterrupted && outcome_.failed == 0 && outcome_.elsewhere == 0;
    store_.setNote(note, isWhole ? "done" : "not done");
    outcome_.seconds = secondsSince(begun);
    outcome_.stages = clock_.stages();
    return outcome_;
  }

 private:
  Survey surveyed() {
    const auto running = clock_.run("survey");
    return surveyScenes(plan_, axes_, &store_, options_.program);
  }

  void runViews(const Survey& survey) {
    std::vector<SweepView> mine;
    for (size_t i = 0; i < survey.views.size(); ++i)
      if (options_.isInShard(i)) mine.push_back(survey.views[i]);
    Progress progress("sweep",
                      static_cast<int>(mine.size() * std::max<size_t>(axes_.maps.size() + axes_.media.size(), 1)));
    // Those that others have claimed are looked at once more at the end: their process may have died.
    std::vector<SweepView> left;
    for (const SweepView& view : mine)
      if (!runView(survey, view, progress, true)) left.push_back(view);
    for (const SweepView& view : left) runView(survey, view, progress, false);
  }

  // False where another process works on it.
  bool runView(const Survey& survey, const SweepView& view, Progress& progress, bool isFirstLook) {
    throwIfInterrupted();
    WantedView missing;
    {
      const auto running = clock_.run("store");
      const WantedView wanted = wantedOf(plan_, axes_, survey, view, machine_);
      missing = missingOf(wanted, store_);
      if (isFirstLook) {
        outcome_.rows += wanted.rowCount();
        outcome_.before += wanted.rowCount() - missing.rowCount();
      }
      if (missing.rowCount() == 0) return true;
      if (!store_.claim(missing.key)) {
        if (!isFirstLook) outcome_.elsewhere += missing.rowCount();
        return false;
      }
      // Whoever had it a moment ago may have just ended.
      const size_t before = missing.rowCount();
      missing = missingOf(missing, store_);
      outcome_.before += before - missing.rowCount();
    }
    if (missing.rowCount() > 0) measure(missing, view, progress);
    const auto running = clock_.run("store");
    store_.release(missing.key);
    return true;
  }

  void measure(const WantedView& missing, const SweepView& view, Progress& progress) {
    try {
      measurer_->enter(view);
    } catch (const WorldError& error) {
      if (missing.cases.empty()) throw;
      for (const WantedCase& one : missing.cases) fail(one.stored, error.what());
      return;
    }
    for (const WantedCase& one : missing.cases) {
      throwIfInterrupted();
      progress.step(fmt::format("{}, {}, {}, {} {}", one.stored.scene, one.stored.camera, one.stored.light,
                                one.stored.map, one.stored.mapSize));
      measureCase(one);
    }
    for (const WantedMedia& one : missing.media) {
      throwIfInterrupted();
      progress.step(fmt::format("{}, {}, {}, medium", one.stored.scene, one.stored.camera, one.stored.light));
      measureMedia(one);
    }
  }

  void measureCase(const WantedCase& wanted) {
    std::optional<SweepMeasurer::Measured> measured;
    try {
      measured = measurer_->measure(wanted, [this](const std::string& method) { return worst_.least(method); });
    } catch (const WorldError& error) {
      return fail(wanted.stored, error.what());
    } catch (const std::bad_alloc&) {
      return fail(wanted.stored, "out of memory");
    }
    const auto running = clock_.run("store");
    failuresInARow_ = 0;
    ++outcome_.cases;
    if (!measured) {
      ++outcome_.empty;
      return store_.putEmpty(wanted.stored, "no surface that the camera sees faces the light");
    }
    store_.put(measured->of, measured->rows);
    outcome_.measured += measured->rows.size();
    constexpr size_t kPruneEvery = 256;  // pictures
    for (const StoredRow& row : measured->rows) {
      worst_.add(row.method, row.row.biasError());
      pictures_ += row.pictures.size();
    }
    if (pictures_ < kPruneEvery) return;
    store_.keepWorstPictures(plan_.worstPictures);
    pictures_ = 0;
  }

  void measureMedia(const WantedMedia& wanted) {
    std::vector<StoredMedium> rows;
    try {
      rows = measurer_->measureMedia(wanted);
    } catch (const WorldError& error) {
      return fail(wanted.stored, error.what());
    }
    const auto running = clock_.run("store");
    failuresInARow_ = 0;
    ++outcome_.cases;
    store_.put(wanted.stored, {}, rows);
    outcome_.measured += rows.size();
  }

  void fail(const StoredCase& of, const std::string& message) {
    ++outcome_.failed;
    const std::string line = oneLine(message);
    if (outcome_.firstFailure.empty())
      outcome_.firstFailure =
          fmt::format("{}, {}, {}, {} {}: {}", of.scene, of.camera, of.light, of.map, of.mapSize, line);
    store_.putFailure(of, line);
    if (++failuresInARow_ >= kMostFailuresInARow)
      throw WorldError(fmt::format("{} cases failed one after another; the last: {}", failuresInARow_, line));
  }

  const Plan& plan_;
  const Axes& axes_;
  Store& store_;
  const SweepOptions& options_;
  std::shared_ptr<const gpu::Device> device_;
  Machine machine_;
  StageClock clock_;
  std::unique_ptr<SweepMeasurer> measurer_;
  SweepOutcome outcome_;
  WorstErrors worst_;
  size_t failuresInARow_ = 0, pictures_ = 0;
};

}  // namespace

SweepOutcome runSweep(const Plan& plan, const Axes& axes, Store& store, const SweepOptions& options) {
  return Runner(plan, axes, store, options).run();
}

}  // namespace gnomon
