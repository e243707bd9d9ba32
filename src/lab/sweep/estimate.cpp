#include "lab/sweep/estimate.h"

#include "base/interrupt.h"
#include "lab/sweep/measure.h"

#include <sys/resource.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <utility>

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMostTries = 12;      // cases
constexpr size_t kMostTriesOfMap = 3;  // on the smallest scene, the middle one, the largest

double secondsSince(Clock::time_point begun) {
  return std::chrono::duration<double>(Clock::now() - begun).count();
}

double each(double seconds, size_t count) {
  return count > 0 ? seconds / static_cast<double>(count) : 0.0;
}

// Per row, of those tried cases that `fits` takes; negative where there are none.
double secondsARow(const std::vector<TriedCase>& tried, const std::function<bool(const CaseShape&)>& fits) {
  double seconds = 0.0;
  size_t rows = 0;
  for (const TriedCase& one : tried) {
    if (!fits(one.shape)) continue;
    seconds += one.seconds;
    rows += one.shape.rows;
  }
  return rows > 0 ? seconds / static_cast<double>(rows) : -1.0;
}

double stageSeconds(const StageClock& clock, const char* stage) {
  for (const auto& [name, seconds] : clock.stages())
    if (name == stage) return seconds;
  return 0.0;
}

// Of this process, up to now.
double peakBytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

struct MissingView {
  SweepView view;
  WantedView missing;
};

struct Try {
  size_t view = 0, at = 0;  // among the missing views, and the view's cases
};

CaseShape shapeOf(const WantedCase& wanted, const Axes& axes) {
  const SweepMap& map = axes.maps[wanted.map];
  return {.map = std::string(map.map->name()) + " " + map.optionsText,
          .size = wanted.stored.mapSize,
          .rows = wanted.rows.size()};
}

// Of each map of one size a few cases, on scenes from the smallest to the largest; in the order of the views.
std::vector<Try> chosenTries(const std::vector<MissingView>& views, const Survey& survey, size_t mapCount) {
  std::vector<std::vector<Try>> byMap(mapCount);
  for (size_t v = 0; v < views.size(); ++v)
    for (size_t i = 0; i < views[v].missing.cases.size(); ++i) byMap[views[v].missing.cases[i].map].push_back({v, i});
  std::erase_if(byMap, [](const std::vector<Try>& all) { return all.empty(); });
  const size_t maps = std::min(byMap.size(), kMostTries);
  const size_t perMap = std::clamp(kMostTries / std::max<size_t>(maps, 1), size_t{1}, kMostTriesOfMap);
  std::vector<Try> tries;
  for (size_t m = 0; m < maps; ++m) {
    std::vector<Try>& all = byMap[m * byMap.size() / maps];
    std::ranges::stable_sort(all, {},
                             [&](const Try& one) { return survey.scenes[views[one.view].view.scene].triangles; });
    const size_t places[] = {0, all.size() - 1, all.size() / 2};
    std::set<size_t> taken;
    for (size_t k = 0; k < perMap; ++k) taken.insert(places[(m + k) % std::size(places)]);
    for (const size_t place : taken) tries.push_back(all[place]);
  }
  std::ranges::sort(tries, {}, [](const Try& one) { return std::pair(one.view, one.at); });
  return tries;
}

}  // namespace

double extrapolatedSeconds(const std::vector<TriedCase>& tried, const std::vector<CaseShape>& missing) {
  double seconds = 0.0;
  for (const CaseShape& one : missing) {
    double aRow = secondsARow(tried, [&](const CaseShape& it) { return it.map == one.map && it.size == one.size; });
    if (aRow < 0.0) aRow = secondsARow(tried, [&](const CaseShape& it) { return it.map == one.map; });
    if (aRow < 0.0) aRow = secondsARow(tried, [](const CaseShape&) { return true; });
    seconds += std::max(aRow, 0.0) * static_cast<double>(one.rows);
  }
  std::set<std::string> maps, triedMaps;
  for (const CaseShape& one : missing) maps.insert(one.map);
  double once = 0.0;
  for (const TriedCase& one : tried) {
    once += one.once;
    triedMaps.insert(one.shape.map);
  }
  return seconds + each(once, triedMaps.size()) * static_cast<double>(maps.size());
}

bool mayHaveCompiled(const TriedCase& one, const std::vector<TriedCase>& before) {
  constexpr double kSlower = 1.3;  // than a machine with other work makes of two equal cases
  const double aRow = secondsARow(before, [&](const CaseShape& it) { return it.map == one.shape.map; });
  return aRow < 0.0 || one.seconds > kSlower * aRow * static_cast<double>(one.shape.rows);
}

SweepEstimate estimateSweep(const Plan& plan, const Axes& axes, Store* store, const SweepOptions& options) {
  std::shared_ptr<const gpu::Device> device = gpu::Device::create(options.device);
  const Machine machine = machineOf(*device, options);
  StageClock clock, unused;
  const Clock::time_point begun = Clock::now();
  const Survey survey = surveyScenes(plan, axes, store, options.program);
  SweepEstimate estimate{.scenes = survey.scenes.size(), .seconds = secondsSince(begun)};
  if (store != nullptr) estimate.before = 0;
  std::vector<MissingView> views;
  std::vector<CaseShape> missingCases;
  std::set<size_t> missingScenes;
  std::set<std::pair<size_t, size_t>> missingCameras;
  size_t missingMedia = 0;
  for (size_t i = 0; i < survey.views.size(); ++i) {
    if (!options.isInShard(i)) continue;
    const SweepView& view = survey.views[i];
    const WantedView wanted = wantedOf(plan, axes, survey, view, machine);
    WantedView missing = store != nullptr ? missingOf(wanted, *store) : wanted;
    ++estimate.views;
    estimate.cases += wanted.cases.size() + wanted.media.size();
    estimate.rows += wanted.rowCount();
    if (estimate.before) *estimate.before += wanted.rowCount() - missing.rowCount();
    if (missing.rowCount() == 0) continue;
    missingScenes.insert(view.scene);
    missingCameras.insert({view.scene, view.camera});
    missingMedia += missing.media.size();
    for (const WantedCase& one : missing.cases) missingCases.push_back(shapeOf(one, axes));
    views.push_back({view, std::move(missing)});
  }
  auto measurer = std::make_unique<SweepMeasurer>(plan, axes, survey, std::move(device), clock);
  std::vector<TriedCase> tried;
  std::set<size_t> scenes;
  std::set<std::pair<size_t, size_t>> cameras;
  const auto enter = [&](const SweepView& view) {
    throwIfInterrupted();
    measurer->enter(view);
    scenes.insert(view.scene);
    cameras.insert({view.scene, view.camera});
  };
  const std::vector<Try> tries = chosenTries(views, survey, axes.maps.size());
  for (const Try& one : tries) {
    enter(views[one.view].view);
    const WantedCase& wanted = views[one.view].missing.cases[one.at];
    const auto secondsOf = [&] {
      throwIfInterrupted();
      const Clock::time_point start = Clock::now();
      measurer->measure(wanted, {});
      return secondsSince(start);
    };
    TriedCase added{.shape = shapeOf(wanted, axes), .seconds = secondsOf()};
    if (mayHaveCompiled(added, tried)) added.seconds = std::min(added.seconds, secondsOf());
    tried.push_back(added);
  }
  double mediaSeconds = 0.0;
  size_t media = 0;
  for (const MissingView& one : views) {
    if (one.missing.media.empty()) continue;
    enter(one.view);
    const Clock::time_point start = Clock::now();
    measurer->measureMedia(one.missing.media.front());
    mediaSeconds = secondsSince(start);
    media = 1;
    break;
  }
  // A sweep has one device and one measurer: its memory is told before there is a second of each, which is made when
  // the first is gone.
  estimate.peakBytes = peakBytes();
  measurer.reset();
  SweepMeasurer afresh(plan, axes, survey, gpu::Device::create(options.device), unused);
  std::set<std::string> triedMaps;
  for (size_t i = 0; i < tries.size(); ++i) {
    if (!triedMaps.insert(tried[i].shape.map).second) continue;
    throwIfInterrupted();
    afresh.enter(views[tries[i].view].view);
    const Clock::time_point start = Clock::now();
    afresh.measure(views[tries[i].view].missing.cases[tries[i].at], {});
    tried[i].once = std::max(secondsSince(start) - tried[i].seconds, 0.0);
  }
  estimate.tried = tried.size() + media;
  estimate.seconds +=
      each(stageSeconds(clock, "scene"), scenes.size()) * static_cast<double>(missingScenes.size()) +
      each(stageSeconds(clock, "G-buffer"), cameras.size()) * static_cast<double>(missingCameras.size()) +
      extrapolatedSeconds(tried, missingCases) + mediaSeconds * static_cast<double>(missingMedia);
  return estimate;
}

}  // namespace gnomon
