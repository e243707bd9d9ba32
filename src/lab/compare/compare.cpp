#include "lab/compare/compare.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "judge/filtered_truth.h"
#include "lab/compare/compare_command.h"
#include "lab/compare/equal_error.h"
#include "lab/compare/method_row.h"
#include "lab/compare/robustness.h"
#include "lab/compare/row_pictures.h"
#include "lab/compare/tune.h"
#include "lab/core/depth_images.h"
#include "lab/core/results_head.h"
#include "lab/picture/flip.h"
#include "lab/picture/pictures.h"
#include "lab/picture/unfold.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include <fmt/format.h>

namespace gnomon {

namespace {

TruthSummary summarize(const Parameterization& map, const GroundTruth& exact) {
  return {.map = map.name(),
          .light = lightFacts(exact.source.name, exact.light),
          .scored = exact.receivers.scored,
          .lit = exact.truth.litCount,
          .facingAway = exact.receivers.facingAway,
          .outsideCone = exact.receivers.outsideCone,
          .margin = exact.truth.margin,
          .marginFlipsHalf = exact.truth.marginFlipsHalf,
          .marginFlipsDouble = exact.truth.marginFlipsDouble,
          .receiversAndTraceMs = exact.ms};
}

// Of a texel. The rasterizer places a triangle's corners on a grid of 1/256 of one (Vulkan's subPixelPrecisionBits), so
// that no map tells apart what lies nearer together; a larger margin would blur what a map can hold.
constexpr double kLargestMargin = 1.0 / 256.0;

// Whether it means the far side of a solid by the second depth, or by the depth of back faces.
bool needsSolids(const BiasMethod& bias) {
  return (bias.channels & (glsl::kChannelSecondDepth | glsl::kChannelBackDepth)) != 0;
}

// Twice the standard error of a median, as a share of it: of normal noise 1.2533 sigma / sqrt(n), where sigma is 1.4826
// times the median deviation. Of few rounds, which tell nothing of it, kUnknownNoise.
double noiseOf(const std::vector<double>& times) {
  constexpr double kUnknownNoise = 0.1;
  constexpr size_t kFewRounds = 5;
  const double middle = median(times);
  if (times.size() < kFewRounds || !(middle > 0.0)) return kUnknownNoise;
  std::vector<double> deviations;
  for (const double ms : times) deviations.push_back(std::abs(ms - middle));
  return 2.0 * 1.2533 * 1.4826 * median(deviations) / std::sqrt(static_cast<double>(times.size())) / middle;
}

// A method, and after it its rows: one a filter, but of a tuned one the row of the filter it was tuned for.
struct Entry {
  Method method;
  std::optional<Tuning> tuning;
  const Filter* tunedFor = nullptr;
  size_t row = 0;  // the first one

  bool has(const Filter& filter) const { return tunedFor == nullptr || tunedFor == &filter; }
};

// Everything of one map: its rows, its summary, its pictures.
class MapComparison {
 public:
  MapComparison(const Session& session, const CompareOptions& options, ShadowPasses& passes,
                const Parameterization& parameterization, const Light& source, std::string folder, Progress& progress)
      : options_(options),
        parameterization_(parameterization),
        lit_(session, passes, parameterization, source, mapSetupOf(options, parameterization)),
        folder_(std::move(folder)),
        progress_(progress) {}

  // False where the camera sees nothing that faces the light.
  bool run(Comparison& comparison) {
    step("exact shadow");
    if (lit_.receivers().scored == 0) {
      comparison.notes.push_back(
          fmt::format("light '{}' lights nothing that the camera sees: no surface faces it (on a {} map)",
                      lit_.source().name, parameterization_.name()));
      return false;
    }
    TruthSummary summary = summarize(parameterization_, lit_.groundTruth());
    step("map");
    const FittedMap& fitted = lit_.fitted();
    summary.zNear = fitted.zNear;
    summary.zFar = fitted.zFar;
    summary.fitNote = fitted.note;
    summary.fitMs = lit_.fitMs();
    summary.texel = medianTexelWidth(lit_);
    for (const Filter* filter : options_.filters) filteredTruth(*filter);

    std::vector<Method> methods;
    for (const BiasMethod* bias : options_.biases) methods.push_back(methodFor(lit_.view(), options_, *bias));
    lit_.expect(methods);
    std::vector<Entry> entries;
    for (const BiasMethod* bias : options_.biases) {
      if (isInterrupted()) break;
      step(bias->name);
      judge(entries, {.method = methodFor(lit_.view(), options_, *bias)});
    }
    try {
      if (options_.tune) judgeTuned(entries);
    } catch (const Interrupted&) {  // out of a search, whose row is left out
    }
    if (entries.empty()) return false;
    timeRows(entries);
    addNotes(summary, comparison.notes);
    comparison.timeNoise = std::max(comparison.timeNoise, timeNoise_);
    comparison.truths.push_back(summary);
    comparison.maps.push_back(summarizeMap(fitted));
    comparison.rows.insert(comparison.rows.end(), rows_.begin(), rows_.end());
    return true;
  }

 private:
  void step(const std::string& what) { progress_.step(fmt::format("{}: {}", parameterization_.name(), what)); }

  const FilteredTruth& filteredTruth(const Filter& filter) {
    const auto found = truths_.find(filter.id);
    if (found != truths_.end()) return found->second;
    FilteredTruth truth;
    truth.visibility = lit_.filteredTruth(filterFor(options_, filter));
    truth.beauty = toSrgb8(lit_.radiance(truth.visibility));
    return truths_.emplace(filter.id, std::move(truth)).first->second;
  }

  void addNotes(const TruthSummary& summary, std::vector<std::string>& notes) const {
    const auto add = [&](const std::string& note) {
      if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
    };
    if (summary.lit == 0)
      add(fmt::format("light '{}' lights nothing that the camera sees: all of it lies in shadow", lit_.source().name));
    if (summary.texel && summary.margin > kLargestMargin * *summary.texel)
      add(
          fmt::format("the exact shadow's margin, {:.2g} m, is {:.2g} of a texel of the {} map ({:.2g} m): what lies "
                      "nearer to another surface than that counts as one with it, and is not judged; take a smaller "
                      "--map-size",
                      summary.margin, summary.margin / *summary.texel, summary.map, *summary.texel));
    std::string names;
    for (const BiasMethod* bias : options_.biases)
      if (needsSolids(*bias)) names += (names.empty() ? "" : ", ") + std::string(bias->name);
    if (!names.empty() && std::ranges::none_of(lit_.view().buffers().draws, &Draw::solid))
      add(fmt::format(
          "{}: made for solids, and the scene has none: no mesh is closed and not doubleSided (gnomon info); "
          "--solids closed takes closed meshes for solids whatever the file says",
          names));
  }

  // Each bias once more at its best, for each filter.
  void judgeTuned(std::vector<Entry>& entries) {
    throwIfInterrupted();
    std::optional<Robustness> robustness;
    if (options_.tuneElsewhere) robustness.emplace(lit_, options_);
    const size_t count = entries.size();
    for (const Filter* filter : options_.filters) {
      const ChosenFilter chosen = filterFor(options_, *filter);
      TuningEvaluator evaluator(lit_, chosen);
      for (size_t i = 0; i < count; ++i) {
        if (knobsOf(*entries[i].method.bias).empty()) continue;
        step(fmt::format("{}, tuning", entries[i].method.bias->name));
        const TunedMethod tuned = tune(evaluator, entries[i].method);
        step(fmt::format("{}, tuned", entries[i].method.bias->name));
        judge(entries, {.method = tuned.method,
                        .tuning = robustness ? robustness->judge(tuned, chosen) : tuningOf(tuned),
                        .tunedFor = filter});
      }
    }
  }

  void judge(std::vector<Entry>& entries, Entry entry) {
    entry.row = rows_.size();
    judgeEntry(entry);
    entries.push_back(std::move(entry));
  }

  void judgeEntry(const Entry& entry) {
    const LabelledResult judged = lit_.judge(entry.method);
    for (const Filter* filter : options_.filters) {
      if (!entry.has(*filter)) continue;
      const FilteredTruth& truth = filteredTruth(*filter);
      std::vector<float> visibility = filter->id == glsl::kShadowFilterNone
                                          ? judged.visibility
                                          : lit_.visibility(entry.method, filterFor(options_, *filter));
      for (const size_t pixel : judged.edgeOn) visibility[pixel] = truth.visibility[pixel];
      Row row = measuredRow(lit_, entry.method, judged, *filter, options_);
      row.tuning = entry.tuning;
      row.rmse = scoredRmse(lit_.receivers(), visibility, truth.visibility);
      // Half a second a row at 1024 x 1024: what binary results have labels for.
      const bool flips = options_.filters.size() > 1 || filter->id != glsl::kShadowFilterNone;
      Image8 beauty;
      if (flips || !options_.outDir.empty()) beauty = toSrgb8(lit_.radiance(visibility));
      if (flips) row.flip = computeFlip(truth.beauty, beauty).mean;
      if (!options_.outDir.empty())
        row.pictures =
            writeRowPictures(lit_.groundTruth(), judged, visibility, beauty, truth, namesOf(row), options_.outDir);
      rows_.push_back(std::move(row));
    }
  }

  RowPictureNames namesOf(const Row& row) const {
    RowPictureNames names;
    names.labelStem = fmt::format("{}/{}{}", folder_, row.bias, row.tuning ? ".tuned" : "");
    names.stem = names.labelStem + (row.isFiltered() ? "." + row.filter : "");
    const bool labelsOfItsOwn = row.isTuned() && options_.filters.size() > 1;
    if (labelsOfItsOwn) names.labelStem = names.stem;
    names.title = fmt::format("{} {}{}, {} x {} texels", row.map, row.bias, row.tuning ? " tuned" : "", row.mapSide,
                              lit_.fitted().map.height);
    names.writesLabels = labelsOfItsOwn || row.filter == options_.filters.front()->name;
    return names;
  }

  // Rounds run one after another through all rows, so that a machine that slows down slows all of them. A
  // tuned row costs what its untuned one costs.
  void timeRows(const std::vector<Entry>& entries) {
    const size_t filterCount = options_.filters.size();
    const size_t biasCount = std::min(options_.biases.size(), entries.size());  // fewer where it is interrupted
    std::map<ChannelSet, std::vector<double>> build;
    std::vector<std::vector<double>> shade(biasCount * filterCount);
    for (int round = -1; round < options_.repeats; ++round) {  // round -1 warms up: pipelines compile at first use
      if (round > 0 && isInterrupted()) break;
      step(round < 0 ? "timing, warm-up" : fmt::format("timing, {} of {}", round + 1, options_.repeats));
      std::map<ChannelSet, double> drawn;
      for (const BiasMethod* bias : std::span(options_.biases).first(biasCount))
        if (!drawn.contains(bias->channels)) drawn[bias->channels] = lit_.redraw(bias->channels);
      if (round >= 0)
        for (const auto& [channels, ms] : drawn) build[channels].push_back(ms);
      for (size_t i = 0; i < shade.size(); ++i) {
        const Method& method = entries[i / filterCount].method;
        const ChosenFilter filter = filterFor(options_, *options_.filters[i % filterCount]);
        if (round < 0)
          lit_.warmUp(method, filter);
        else
          shade[i].push_back(lit_.timeVisibility(method, filter));
      }
    }
    std::vector<double> noises;
    for (const std::vector<double>& times : shade) noises.push_back(noiseOf(times));
    for (const auto& [channels, times] : build) noises.push_back(noiseOf(times));
    timeNoise_ = median(noises);
    for (const Entry& entry : entries) {
      const auto like = std::ranges::find(options_.biases, entry.method.bias) - options_.biases.begin();
      size_t at = entry.row;
      for (size_t f = 0; f < filterCount; ++f) {
        if (!entry.has(*options_.filters[f])) continue;
        Row& row = rows_[at++];
        row.buildMs = median(build[entry.method.bias->channels]);
        row.shadeMs = median(shade[static_cast<size_t>(like) * filterCount + f]);
      }
    }
  }

  MapSummary summarizeMap(const FittedMap& fitted) {
    MapSummary summary{.map = parameterization_.name(),
                       .light = lit_.source().name,
                       .width = fitted.map.width,
                       .height = fitted.map.height,
                       .layers = fitted.map.sliceCount,
                       .zNear = fitted.zNear,
                       .zFar = fitted.zFar};
    if (const std::optional<SolidAngles> angles = computeSolidAngles(fitted))
      summary.solidAngles = {.smallest = angles->smallest, .largest = angles->largest};
    if (options_.outDir.empty()) return summary;
    const bool two = std::ranges::any_of(
        options_.biases, [](const BiasMethod* b) { return (b->channels & glsl::kChannelSecondDepth) != 0; });
    const Occluders& drawn = lit_.occluders(glsl::kChannelDepth | (two ? glsl::kChannelSecondDepth : 0));
    const FilteredTruth& plain = filteredTruth(filters().front());
    summary.pictures = writeMapPictures(lit_.view().device(), lit_.receivers(), drawn, plain, options_.outDir, folder_);
    for (const Filter* filter : options_.filters)
      if (filter->id != glsl::kShadowFilterNone)
        summary.filteredTruths.emplace_back(
            filter->name, writeFilteredTruth(lit_.receivers(), filteredTruth(*filter), options_.outDir,
                                             fmt::format("{}/truth.{}", folder_, filter->name)));
    return summary;
  }

  const CompareOptions& options_;
  const Parameterization& parameterization_;
  LightOnMap lit_;
  const std::string folder_;  // below outDir
  Progress& progress_;
  std::map<int, FilteredTruth> truths_;  // by filter
  std::vector<Row> rows_;
  double timeNoise_ = 0.0;
};

// One more row for each method on each map: what all lights together get wrong. The map's texels are those of
// one light. None of a method that was interrupted before its last light.
void addSums(Comparison& comparison) {
  std::vector<Row> sums;
  for (const Row& row : comparison.rows) {
    const auto isLike = [&](const Row& other) {
      return other.map == row.map && other.bias == row.bias && other.filter == row.filter &&
             other.isTuned() == row.isTuned();
    };
    const auto ofItsMap = std::ranges::count(comparison.truths, row.map, &TruthSummary::map);
    if (std::ranges::count_if(comparison.rows, isLike) < ofItsMap) continue;
    const auto same = [&](const Row& sum) {
      return sum.map == row.map && sum.bias == row.bias && sum.filter == row.filter &&
             sum.tuning.has_value() == row.tuning.has_value();
    };
    const auto found = std::ranges::find_if(sums, same);
    if (found == sums.end()) {
      sums.push_back(row);
      Row& sum = sums.back();
      sum.light = "all";
      sum.isSum = true;
      sum.pictures.clear();
      sum.worstAcne = sum.worstLeak = std::nullopt;
      sum.walks = std::nullopt;
      sum.flip = std::nullopt;
      if (sum.tuning) {  // of the bias each light has its own values; the filter is one for all
        std::erase_if(sum.params, [&](const Param& param) { return sum.isKnob(param) && !isFilterParam(param.name); });
        std::erase_if(sum.units, [](const auto& unit) { return !isFilterParam(unit.first); });
      }
      continue;
    }
    const double squares = found->rmse * found->rmse * static_cast<double>(found->scored) +
                           row.rmse * row.rmse * static_cast<double>(row.scored);
    for (const auto count : {&Row::scored, &Row::agree, &Row::acne, &Row::leak, &Row::edgeShadow, &Row::edgeLight,
                             &Row::uncovered, &Row::grazing, &Row::edgeOn})
      (*found).*count += row.*count;
    for (const auto count : {&Row::unseenOccluder, &Row::unseenSurface})
      if (row.*count) (*found).*count = ((*found).*count).value_or(0) + *(row.*count);
    found->rmse = std::sqrt(squares / static_cast<double>(found->scored));
    found->buildMs += row.buildMs;
    found->shadeMs += row.shadeMs;
  }
  comparison.rows.insert(comparison.rows.end(), sums.begin(), sums.end());
}

void finishRows(const Session& session, const CompareOptions& options, Comparison& comparison) {
  for (Row& row : comparison.rows) {
    row.frameMs = comparison.gbufferMs + row.buildMs + row.shadeMs;
    row.command = rowCommand(session.setup(), options, row);
  }
}

int stepsPerMap(const CompareOptions& options) {
  const auto tuned = std::ranges::count_if(
      options.biases, [&](const BiasMethod* bias) { return options.tune && !knobsOf(*bias).empty(); });
  const int tunedRows = static_cast<int>(tuned) * static_cast<int>(options.filters.size());
  return 3 + options.repeats + static_cast<int>(options.biases.size()) + 2 * tunedRows;
}

}  // namespace

CompareOptions optionsFor(const CompareOptions& options, const Parameterization& map) {
  CompareOptions own = options;
  std::erase_if(own.biases, [&](const BiasMethod* bias) { return !map.supportsBias(*bias); });
  std::erase_if(own.filters,
                [&](const Filter* filter) { return filter->id != glsl::kShadowFilterNone && !map.supportsFilters(); });
  return own;
}

Comparison compare(const Session& session, const CompareOptions& options) {
  Comparison comparison;
  std::vector<double> gbuffer;
  for (int i = 0; i < options.repeats; ++i) gbuffer.push_back(session.timeGBuffer());
  comparison.gbufferMs = median(gbuffer);

  ShadowPasses passes(session);
  struct Job {
    const Parameterization* map;
    Light light;
    size_t number;  // of the light
  };
  std::vector<Job> jobs;
  for (const Parameterization* map : options.maps) {
    const std::vector<Light> lights = chooseLights(session.setup(), session.tracer(), *map);
    for (size_t i = 0; i < lights.size(); ++i) jobs.push_back({map, lights[i], i});
    if (session.setup().light != "all") continue;
    for (const Light& light : session.scene().lights)
      if (std::ranges::find(lights, light.name, &Light::name) == lights.end())
        comparison.notes.push_back(
            fmt::format("light '{}' is left out: a {} map is not made for its kind", light.name, map->name()));
  }
  const bool severalLights = jobs.size() > options.maps.size();
  int steps = 0;
  for (const Job& job : jobs) steps += stepsPerMap(optionsFor(options, *job.map));
  {
    Progress progress(options.progressTitle, steps);
    for (const auto& [map, light, number] : jobs) {
      if (isInterrupted()) break;
      const CompareOptions own = optionsFor(options, *map);
      const std::string folder = severalLights ? fmt::format("{}/light{}", map->name(), number) : map->name();
      MapComparison(session, own, passes, *map, light, folder, progress).run(comparison);
      if (!options.soFar || comparison.rows.empty() || isInterrupted()) continue;
      Comparison soFar = comparison;
      soFar.isComplete = false;
      finishRows(session, options, soFar);
      options.soFar(soFar);
    }
  }
  if (comparison.rows.empty()) {
    throwIfInterrupted();
    openLight(session, passes, *options.maps.front(), {});  // says why
  }
  if (severalLights) addSums(comparison);
  try {
    throwIfInterrupted();
    if (options.recommend) measureRecommended(session, passes, options, comparison.rows);
    if (options.untilError) comparison.equalError = findEqualError(session, passes, options, comparison.gbufferMs);
  } catch (const Interrupted&) {  // what was measured before stays
  }
  finishRows(session, options, comparison);
  comparison.isComplete = !isInterrupted();
  return comparison;
}

}  // namespace gnomon
