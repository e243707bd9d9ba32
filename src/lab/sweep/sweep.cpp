#include "lab/sweep/sweep.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/message.h"
#include "base/progress.h"
#include "lab/sweep/measure.h"
#include "lab/sweep/results_version.h"
#include "lab/sweep/slurm.h"

#include <sys/resource.h>

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

Machine machineOf(const gpu::Device& device, const SweepOptions& options) {
  return {.program = options.program,
          .results = resultsVersion(),
          .device = device.info().name,
          .driver = device.info().driver,
          .host = machineName()};
}

// What of a view is not in the store.
WantedView missingOf(const WantedView& wanted, Store& store) {
  WantedView missing{.key = wanted.key};
  const auto isThere = [&](const auto& row) { return store.has(row.key, row.slot); };
  for (WantedCase one : wanted.cases) {
    std::erase_if(one.rows, isThere);
    if (!one.rows.empty() && !store.isEmpty(one.stored.key)) missing.cases.push_back(std::move(one));
  }
  for (WantedMedia one : wanted.media) {
    std::erase_if(one.rows, isThere);
    if (!one.rows.empty() && !store.isEmpty(one.stored.key)) missing.media.push_back(std::move(one));
  }
  return missing;
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
      if (i % static_cast<size_t>(options_.shards) == static_cast<size_t>(options_.shard))
        mine.push_back(survey.views[i]);
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

SweepEstimate estimateSweep(const Plan& plan, const Axes& axes, Store* store, const SweepOptions& options) {
  const std::shared_ptr<const gpu::Device> device = gpu::Device::create(options.device);
  const Machine machine = machineOf(*device, options);
  StageClock clock;
  const Clock::time_point begun = Clock::now();
  const Survey survey = surveyScenes(plan, axes, store, options.program);
  SweepEstimate estimate{.scenes = survey.scenes.size(), .seconds = secondsSince(begun)};
  if (store != nullptr) estimate.before = 0;
  // What is missing: cases by scene and axis of the map.
  struct Try {
    SweepView view;
    WantedView missing;
  };
  std::vector<Try> tries;
  size_t missingCases = 0, missingViews = 0, missingMedia = 0;
  for (size_t i = 0; i < survey.views.size(); ++i) {
    if (i % static_cast<size_t>(options.shards) != static_cast<size_t>(options.shard)) continue;
    const WantedView wanted = wantedOf(plan, axes, survey, survey.views[i], machine);
    WantedView missing = store != nullptr ? missingOf(wanted, *store) : wanted;
    ++estimate.views;
    estimate.cases += wanted.cases.size() + wanted.media.size();
    estimate.rows += wanted.rowCount();
    if (estimate.before) *estimate.before += wanted.rowCount() - missing.rowCount();
    if (missing.rowCount() == 0) continue;
    ++missingViews;
    missingCases += missing.cases.size();
    missingMedia += missing.media.size();
    if (tries.empty() || tries.back().view.scene != survey.views[i].scene)
      tries.push_back({survey.views[i], std::move(missing)});
  }
  // The smallest scene, the middle one, the largest.
  std::ranges::sort(tries, {}, [&](const Try& one) { return survey.scenes[one.view.scene].triangles; });
  std::vector<size_t> chosen;
  for (const size_t at : {size_t{0}, tries.size() / 2, tries.size() - std::min<size_t>(tries.size(), 1)})
    if (at < tries.size() && std::ranges::find(chosen, at) == chosen.end()) chosen.push_back(at);
  SweepMeasurer measurer(plan, axes, survey, device, clock);
  double viewSeconds = 0.0, caseSeconds = 0.0, mediaSeconds = 0.0;
  size_t cases = 0, media = 0;
  for (const size_t at : chosen) {
    Clock::time_point start = Clock::now();
    measurer.enter(tries[at].view);
    viewSeconds += secondsSince(start);
    const std::vector<WantedCase>& all = tries[at].missing.cases;
    for (size_t i = 0; i < all.size(); i += std::max<size_t>(all.size() / 2, 1)) {
      throwIfInterrupted();
      start = Clock::now();
      measurer.measure(all[i], {});
      caseSeconds += secondsSince(start);
      ++cases;
    }
    if (tries[at].missing.media.empty() || media > 0) continue;
    start = Clock::now();
    measurer.measureMedia(tries[at].missing.media.front());
    mediaSeconds += secondsSince(start);
    ++media;
  }
  const auto each = [](double seconds, size_t count) { return count > 0 ? seconds / static_cast<double>(count) : 0.0; };
  estimate.tried = cases + media;
  estimate.seconds += each(viewSeconds, chosen.size()) * static_cast<double>(missingViews) +
                      each(caseSeconds, cases) * static_cast<double>(missingCases) +
                      each(mediaSeconds, media) * static_cast<double>(missingMedia);
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  estimate.peakBytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  return estimate;
}

}  // namespace gnomon
