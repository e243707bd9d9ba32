#include "lab/compare/equal_error.h"

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "lab/compare/recommendation.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr int kStepsPerDoubling = 4;
constexpr int kFirstStep = 4 * kStepsPerDoubling;  // 16 texels a side

int sideOf(int step) {
  return static_cast<int>(std::lround(std::exp2(static_cast<double>(step) / kStepsPerDoubling)));
}

// One method's search over the steps of a map's side.
class SideSearch {
 public:
  SideSearch(Method method, double limit, int lastStep) : method_(method), limit_(limit), last_(lastStep) {}

  const Method& method() const { return method_; }
  // The next step to try; none where the search has ended.
  std::optional<int> next() const {
    if (!good_) {
      if (bad_ == last_) return std::nullopt;
      return bad_ ? std::min(*bad_ + kStepsPerDoubling, last_) : std::min(kFirstStep, last_);
    }
    if (!bad_ || *good_ - *bad_ <= 1) return std::nullopt;
    return (*good_ + *bad_) / 2;
  }
  void tried(int step, const SizedError& sized) {
    (sized.allWrong <= limit_ ? good_ : bad_) = step;
    sizes_[step] = sized;
  }
  // The device cannot hold a map of this step: the largest one is what was tried last. False where nothing was.
  bool endBefore(int step) {
    if (!bad_) return false;
    last_ = std::min(step, *bad_);
    return true;
  }
  EqualErrorMethod result() const {
    EqualErrorMethod result{.bias = method_.bias->name};
    if (good_) result.smallest = sizes_.at(*good_);
    for (const auto& [step, sized] : sizes_) result.sizes.push_back(sized);
    return result;
  }

 private:
  Method method_;
  double limit_;
  int last_;
  std::optional<int> bad_, good_;  // the largest that is not good enough, the smallest that is
  std::map<int, SizedError> sizes_;
};

size_t wrongPixels(const LightOnMap& lit, const std::vector<glsl::PixelDiagnosis>& diagnosis) {
  size_t wrong = 0;
  for (size_t i = 0; i < diagnosis.size(); ++i) {
    if (lit.receivers().states[i] != PixelState::Scored) continue;
    const Verdict verdict = verdictOf(diagnosis[i]);  // NotAsked: edge-on within rounding, counted as agreeing
    wrong += verdict != (lit.truth().lit[i] != 0 ? Verdict::Lit : Verdict::Shadow) && verdict != Verdict::NotAsked;
  }
  return wrong;
}

// Methods that read the same channels, on one map.
void trySize(LightOnMap& lit, int step, const std::vector<SideSearch*>& searches, int repeats, double gbufferMs) {
  const ChannelSet channels = searches.front()->method().bias->channels;
  const FittedMap& fitted = lit.fitted();
  SizedError sized{.mapSide = fitted.map.width,
                   .mapTexels = size_t{1} * fitted.map.width * fitted.map.height * fitted.map.sliceCount,
                   .mapBytes = mapBytes(fitted, channels)};
  std::vector<double> build;
  std::vector<std::vector<double>> shade(searches.size());
  for (int round = -1; round < repeats; ++round) {  // round -1 warms up
    const double drawn = lit.redraw(channels);
    if (round >= 0) build.push_back(drawn);
    for (size_t i = 0; i < searches.size(); ++i) {
      if (round < 0)
        lit.warmUp(searches[i]->method());
      else
        shade[i].push_back(lit.timeVisibility(searches[i]->method()));
    }
  }
  std::vector<Method> methods;
  for (const SideSearch* search : searches) methods.push_back(search->method());
  lit.expect(methods);
  sized.buildMs = median(build);
  for (size_t i = 0; i < searches.size(); ++i) {
    const size_t wrong = wrongPixels(lit, lit.diagnose(searches[i]->method()));
    sized.allWrong = static_cast<double>(wrong) / static_cast<double>(lit.receivers().scored);
    sized.shadeMs = median(shade[i]);
    sized.frameMs = gbufferMs + sized.buildMs + sized.shadeMs;
    searches[i]->tried(step, sized);
  }
}

// The least step that a search asks for, and which ask for it, by the channels that they read.
struct Round {
  int step = 0;
  std::map<ChannelSet, std::vector<SideSearch*>> searches;
};

std::optional<Round> nextRound(std::vector<SideSearch>& searches) {
  std::optional<int> least;
  for (const SideSearch& search : searches)
    if (const auto step = search.next()) least = std::min(least.value_or(*step), *step);
  if (!least) return std::nullopt;
  Round round{.step = *least};
  for (SideSearch& search : searches)
    if (search.next() == least) round.searches[search.method().bias->channels].push_back(&search);
  return round;
}

// One light on one kind of map.
std::vector<EqualErrorMethod> searchMap(const LightOnMap& lit, const CompareOptions& options, double gbufferMs,
                                        Progress& progress) {
  const int last = static_cast<int>(std::floor(std::log2(options.untilMapSide) * kStepsPerDoubling + 1e-9));
  std::vector<SideSearch> searches;
  for (const BiasMethod* bias : options.biases)
    searches.emplace_back(methodFor(lit.view(), options, *bias), *options.untilError, last);
  while (const std::optional<Round> round = nextRound(searches)) {
    throwIfInterrupted();
    progress.step(fmt::format("{}: {} texels a side", lit.parameterization().name(), sideOf(round->step)));
    MapSetup setup = lit.setup();
    setup.side = sideOf(round->step);
    for (const auto& [channels, asking] : round->searches) {
      LightOnMap sized(lit, setup);  // of its own: large maps of all channels at once may not fit
      try {
        trySize(sized, round->step, asking, options.repeats, gbufferMs);
      } catch (const WorldError&) {
        if (!std::ranges::all_of(asking, [&](SideSearch* search) { return search->endBefore(round->step); })) throw;
      }
    }
  }
  std::vector<EqualErrorMethod> results;
  for (const SideSearch& search : searches) {
    results.push_back(search.result());
    results.back().map = lit.parameterization().name();
    results.back().light = lit.source().name;
  }
  return results;
}

}  // namespace

EqualError findEqualError(const Session& session, ShadowPasses& passes, const CompareOptions& options,
                          double gbufferMs) {
  EqualError found{.limit = *options.untilError, .largestSide = options.untilMapSide};
  constexpr int kUsualSizes = 12;  // of a map
  Progress progress("equal error", kUsualSizes * static_cast<int>(options.maps.size()));
  for (const Parameterization* map : options.maps) {
    if (!map->supportsFilters()) continue;
    for (const Light& light : chooseLights(session.setup(), session.tracer(), *map)) {
      const LightOnMap lit(session, passes, *map, light, mapSetupOf(options, *map));
      if (lit.receivers().scored == 0) continue;
      for (EqualErrorMethod& method : searchMap(lit, optionsFor(options, *map), gbufferMs, progress))
        found.methods.push_back(std::move(method));
    }
  }
  // By nothing that is timed: the same command gives the same order.
  std::ranges::stable_sort(found.methods, {}, [](const EqualErrorMethod& method) {
    return method.smallest ? std::pair(0.0, static_cast<double>(method.smallest->mapBytes))
                           : std::pair(1.0, method.sizes.back().allWrong);
  });
  return found;
}

std::string equalErrorTable(const Comparison& comparison) {
  if (!comparison.equalError) return "";
  const EqualError& equal = *comparison.equalError;
  const bool several = std::ranges::any_of(comparison.rows, &Row::isSum);
  size_t mapWidth = 4, biasWidth = 4;
  const auto mapText = [&](const EqualErrorMethod& method) {
    return several ? method.map + ", " + method.light : method.map;
  };
  for (const EqualErrorMethod& method : equal.methods) {
    mapWidth = std::max(mapWidth, mapText(method).size());
    biasWidth = std::max(biasWidth, method.bias.size());
  }
  std::string text = fmt::format(
      "smallest map with at most {} of all pixels wrong, of 16 to {} texels a side\n"
      "{:<{}} {:<{}} {:>6} {:>9} {:>10} {:>9} {:>9} {:>9}\n",
      percentText(equal.limit), equal.largestSide, "map", mapWidth, "bias", biasWidth, "side", "MiB", "all wrong",
      "build ms", "shade ms", "frame ms");
  for (const EqualErrorMethod& method : equal.methods) {
    text += fmt::format("{:<{}} {:<{}} ", mapText(method), mapWidth, method.bias, biasWidth);
    if (const auto& s = method.smallest)
      text += fmt::format("{:>6} {:>9.2f} {:>9.4f}% {:>9.2f} {:>9.2f} {:>9.2f}\n", s->mapSide,
                          static_cast<double>(s->mapBytes) / (1 << 20), 100.0 * s->allWrong, s->buildMs, s->shadeMs,
                          s->frameMs);
    else
      text +=
          fmt::format("none: {} wrong at {}\n", percentText(method.sizes.back().allWrong), method.sizes.back().mapSide);
  }
  return text;
}

}  // namespace gnomon
