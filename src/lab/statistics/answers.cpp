#include "lab/statistics/answers.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr size_t kWorstPerMethod = 10;

// Numbers of the bootstrap's groups, one a case; `byScenes` as in Answers.
std::vector<size_t> groupsOf(const CaseTable& table, bool byScenes) {
  std::vector<size_t> groups;
  for (const MeasuredCase& one : table.cases) groups.push_back(byScenes ? one.scene : one.view);
  return groups;
}

bool isIn(const Subset& subset, const MeasuredCase& one) {
  const auto fits = [](int wanted, size_t value) { return wanted < 0 || static_cast<size_t>(wanted) == value; };
  return fits(subset.scene, one.scene) && fits(subset.map, one.map) && fits(subset.size, one.size);
}

std::optional<double> meanTime(double sum, size_t count) {
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

MethodAnswer answerOf(size_t method, const std::vector<const MeasuredCase*>& cases, const std::vector<size_t>& groups,
                      const Resamples& resamples) {
  MethodAnswer answer{.method = method};
  std::vector<GroupedValue> errors, allWrong, biasErrors;
  double frame = 0.0, build = 0.0, shade = 0.0, texels = 0.0;
  size_t timed = 0;
  for (size_t i = 0; i < cases.size(); ++i) {
    errors.push_back({cases[i]->error, groups[i]});
    allWrong.push_back({cases[i]->allWrong, groups[i]});
    biasErrors.push_back({cases[i]->biasError, groups[i]});
    texels += static_cast<double>(cases[i]->texels);
    if (!cases[i]->frameMs) continue;
    ++timed;
    frame += *cases[i]->frameMs;
    build += *cases[i]->buildMs;
    shade += *cases[i]->shadeMs;
  }
  answer.error = estimatesOf(errors, resamples);
  answer.allWrong = meanOf(allWrong, resamples);
  answer.biasError = meanOf(biasErrors, resamples);
  answer.frameMs = meanTime(frame, timed);
  answer.buildMs = meanTime(build, timed);
  answer.shadeMs = meanTime(shade, timed);
  answer.texels = texels / static_cast<double>(std::max<size_t>(cases.size(), 1));
  return answer;
}

// Of a subset within one scene, views are drawn: its only scene would always be drawn.
Subset subsetOf(const CaseTable& table, Subset subset, bool byScenes) {
  const bool draws = byScenes && subset.scene < 0;
  const std::vector<size_t> groups = groupsOf(table, draws);
  const Resamples resamples(draws ? table.scenes.size() : table.views.size(), kResamples, kBootstrapSeed);
  std::vector<std::vector<const MeasuredCase*>> cases(table.methods.size());
  std::vector<std::vector<size_t>> own(table.methods.size());
  std::set<std::tuple<size_t, size_t, size_t>> different;
  for (size_t i = 0; i < table.cases.size(); ++i) {
    const MeasuredCase& one = table.cases[i];
    if (!isIn(subset, one)) continue;
    cases[one.method].push_back(&one);
    own[one.method].push_back(groups[i]);
    different.insert({one.view, one.map, one.size});
  }
  subset.cases = different.size();
  for (size_t m = 0; m < cases.size(); ++m)
    if (!cases[m].empty()) subset.methods.push_back(answerOf(m, cases[m], own[m], resamples));
  std::ranges::stable_sort(subset.methods, {}, [](const MethodAnswer& answer) { return answer.error.mean.value; });
  return subset;
}

std::vector<Pair> pairsOf(const Answers& answers) {
  const CaseTable& table = answers.table;
  const std::vector<size_t> groups = groupsOf(table, answers.byScenes);
  const Resamples resamples(answers.groups, kResamples, kBootstrapSeed);
  using Place = std::tuple<size_t, size_t, size_t>;
  std::vector<std::map<Place, size_t>> cases(table.methods.size());  // to numbers of cases
  for (size_t i = 0; i < table.cases.size(); ++i) {
    const MeasuredCase& one = table.cases[i];
    cases[one.method].emplace(Place{one.view, one.map, one.size}, i);
  }
  std::vector<Pair> pairs;
  const std::vector<MethodAnswer>& ranked = answers.whole().methods;
  for (size_t first = 0; first < ranked.size(); ++first) {
    for (size_t second = first + 1; second < ranked.size(); ++second) {
      Pair pair{.a = ranked[first].method, .b = ranked[second].method};
      std::vector<GroupedValue> differences;
      for (const auto& [place, i] : cases[pair.a]) {
        const auto found = cases[pair.b].find(place);
        if (found == cases[pair.b].end()) continue;
        const double difference = table.cases[found->second].error - table.cases[i].error;
        pair.aWins += difference > 0.0 ? 1 : 0;
        pair.bWins += difference < 0.0 ? 1 : 0;
        differences.push_back({difference, groups[i]});
      }
      pair.cases = differences.size();
      if (differences.empty()) continue;
      pair.difference = meanOf(differences, resamples);
      pairs.push_back(pair);
    }
  }
  return pairs;
}

void markFront(std::vector<ParetoPoint>& points, bool byTime) {
  const auto cost = [&](const ParetoPoint& point) { return byTime ? point.frameMs.value_or(-1.0) : point.texels; };
  for (ParetoPoint& point : points) {
    if (byTime && !point.frameMs) continue;
    const bool beaten = std::ranges::any_of(points, [&](const ParetoPoint& other) {
      if (byTime && !other.frameMs) return false;
      return cost(other) <= cost(point) && other.error <= point.error &&
             (cost(other) < cost(point) || other.error < point.error);
    });
    (byTime ? point.leastTime : point.leastTexels) = !beaten;
  }
}

std::vector<ParetoPoint> paretoOf(const Answers& answers) {
  std::vector<ParetoPoint> points;
  for (const Subset& subset : answers.subsets) {
    if (subset.scene >= 0 || subset.map < 0 || subset.size < 0) continue;
    for (const MethodAnswer& answer : subset.methods)
      points.push_back({.method = answer.method,
                        .map = static_cast<size_t>(subset.map),
                        .size = static_cast<size_t>(subset.size),
                        .error = answer.error.mean.value,
                        .texels = answer.texels,
                        .frameMs = answer.frameMs});
  }
  markFront(points, false);
  markFront(points, true);
  return points;
}

std::vector<WorstCase> worstOf(const Store& store, const CaseTable& table) {
  std::vector<std::vector<const MeasuredCase*>> cases(table.methods.size());
  for (const MeasuredCase& one : table.cases)
    if (one.error > 0.0) cases[one.method].push_back(&one);
  std::vector<WorstCase> worst;
  sql::Statement facts =
      store.database().prepare("SELECT scene, light, camera, map, map_size, command FROM results WHERE key=?");
  sql::Statement picture = store.database().prepare("SELECT kind, png FROM pictures WHERE key=?");
  for (size_t m = 0; m < cases.size(); ++m) {
    std::ranges::stable_sort(cases[m], std::greater(), &MeasuredCase::error);
    for (size_t i = 0; i < std::min(cases[m].size(), kWorstPerMethod); ++i) {
      const MeasuredCase& one = *cases[m][i];
      if (!facts.with(one.key).step()) continue;
      WorstCase shown{.method = m,
                      .error = one.error,
                      .scene = facts.text(0),
                      .light = facts.text(1),
                      .camera = facts.text(2),
                      .map = facts.text(3),
                      .command = facts.text(5),
                      .mapSize = static_cast<int>(facts.integer(4))};
      if (picture.with(one.key).step()) {
        shown.label = picture.text(0);
        shown.png = picture.text(1);
      }
      picture.reset();
      worst.push_back(std::move(shown));
    }
  }
  facts.reset();
  return worst;
}

}  // namespace

const Subset* Answers::find(int scene, int map, int size) const {
  const auto found = std::ranges::find_if(
      subsets, [&](const Subset& subset) { return subset.scene == scene && subset.map == map && subset.size == size; });
  return found == subsets.end() ? nullptr : &*found;
}

Answers answersOf(const Store& store, const CaseFilter& filter) {
  Answers answers{.table = measuredCases(store, filter)};
  const CaseTable& table = answers.table;
  answers.byScenes = table.scenes.size() >= kFewScenes;
  answers.groups = answers.byScenes ? table.scenes.size() : table.views.size();
  for (int scene = -1; scene < static_cast<int>(table.scenes.size()); ++scene)
    for (int map = -1; map < static_cast<int>(table.maps.size()); ++map)
      for (int size = -1; size < static_cast<int>(table.sizes.size()); ++size) {
        Subset subset = subsetOf(table, {.scene = scene, .map = map, .size = size}, answers.byScenes);
        if (subset.cases > 0) answers.subsets.push_back(std::move(subset));
      }
  answers.pairs = pairsOf(answers);
  answers.pareto = paretoOf(answers);
  answers.worst = worstOf(store, table);
  return answers;
}

}  // namespace gnomon
