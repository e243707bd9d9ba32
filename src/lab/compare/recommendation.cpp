#include "lab/compare/recommendation.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

namespace gnomon {

namespace {

std::string errorText(const Row& row, double biasError, double allWrong, std::optional<double> rmse) {
  std::string text = fmt::format("bias error {}, all wrong {}", percentText(biasError), percentText(allWrong));
  if (row.isFiltered()) text = fmt::format("RMSE {:.4f} through {}, ", rmse.value_or(0.0), row.filter) + text;
  return text;
}

std::string costText(const Row& row) {
  return fmt::format("{:.3g} ms a frame (map {:.3g}, shading {:.3g}), {:.3g} MiB", row.frameMs, row.buildMs,
                     row.shadeMs, static_cast<double>(row.mapBytes) / (1 << 20));
}

std::string configuration(const Row& row) {
  const std::string knobs = knobText(row);
  const char* where = row.isTuned() ? "" : row.isGiven ? "as given" : "at its default";
  std::string text = fmt::format("{} on a {} map of {}", row.bias, row.map, row.mapDimensions);
  if (*where != '\0') text += fmt::format(", {}", where);
  return knobs.empty() ? text : fmt::format("{} ({})", text, knobs);
}

// "0.1% to 2%", where the comparison has several lights.
std::string overLights(const Comparison& comparison, const Row& sum) {
  std::vector<double> errors;
  for (const Row& row : comparison.rows)
    if (!row.isSum && row.map == sum.map && row.bias == sum.bias && row.filter == sum.filter &&
        row.isTuned() == sum.isTuned())
      errors.push_back(row.biasError());
  if (!sum.isSum || errors.size() < 2) return "";
  const auto [least, most] = std::ranges::minmax(errors);
  return fmt::format("; over {} lights bias errors of {} to {}", errors.size(), percentText(least), percentText(most));
}

std::string elsewhereText(const Row& row) {
  std::string text;
  const auto add = [&](const std::string& where, const ErrorElsewhere& there) {
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", where,
                        errorText(row, there.biasError, there.allWrong, there.rmse));
  };
  if (!row.elsewhere) return "";
  if (const auto& there = row.elsewhere->otherCamera) add("from camera '" + there->camera + "'", *there);
  if (const auto& there = row.elsewhere->otherMapSize) add(fmt::format("on a map of {}", there->mapSize), *there);
  return text;
}

// Of a value that was tuned here, there, and of the best one there.
std::string transferText(const Row& row) {
  std::string text;
  const auto add = [&](const std::string& where, const Transfer& there) {
    const std::string errors =
        there.rmse ? fmt::format("RMSE {:.4f} (best there {:.4f})", *there.rmse, there.bestRmse.value_or(0.0))
                   : fmt::format("bias error {} (best there {})", percentText(there.biasError),
                                 percentText(there.bestBiasError));
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ", where, errors);
  };
  if (!row.tuning) return "";
  if (const auto& there = row.tuning->otherCamera) add("from camera '" + there->camera + "'", *there);
  if (const auto& there = row.tuning->otherMapSize) add(fmt::format("on a map of {}", there->mapSize), *there);
  return text;
}

std::string twoLines(const Comparison& comparison, const char* begins, const Row& row, const std::string& elsewhere) {
  std::string text = fmt::format("{} {}: {}; {}\n", begins, configuration(row),
                                 errorText(row, row.biasError(), row.allWrong(), row.rmse), costText(row));
  const std::string rest = elsewhere + overLights(comparison, row);
  if (!rest.empty()) text += fmt::format("  elsewhere: {}\n", rest.starts_with("; ") ? rest.substr(2) : rest);
  return text;
}

// What the exact shadow itself cannot tell: pixels that change with its margin, of the lights that a row sums.
size_t undecidedPixels(const Comparison& comparison, const Row& row) {
  size_t pixels = 0;
  for (const TruthSummary& truth : comparison.truths)
    if (truth.map == row.map && (row.isSum || truth.light.name == row.light))
      pixels += std::max(truth.marginFlipsHalf, truth.marginFlipsDouble);
  return pixels;
}

// Rows of the same filter that are no worse than the best one by more than the exact shadow can tell, cheapest first.
std::string equallyGood(const Comparison& comparison, const std::vector<Row>& rows, const Row& best) {
  constexpr size_t kNamed = 3;
  const size_t undecided = undecidedPixels(comparison, best);
  std::vector<const Row*> equals;
  for (const Row& row : rows)
    if (&row != &best && row.isSum == best.isSum && row.light == best.light && row.filter == best.filter &&
        !row.isTuned() && row.acne + row.leak <= best.acne + best.leak + undecided &&
        row.wrong() <= best.wrong() + undecided)
      equals.push_back(&row);
  if (equals.empty() || best.isFiltered()) return "";
  std::ranges::stable_sort(equals, {}, &Row::frameMs);
  std::string names;
  for (const Row* row : std::span(equals).first(std::min(equals.size(), kNamed)))
    names += fmt::format("{}{} on a {} map ({:.3g} ms)", names.empty() ? "" : ", ", row->bias, row->map, row->frameMs);
  if (equals.size() > kNamed) names += fmt::format(" and {} more", equals.size() - kNamed);
  const std::string within =
      undecided == 0 ? "" : fmt::format(", within the {} pixels that the exact shadow cannot tell", undecided);
  return fmt::format("  as good{}: {}\n", within, names);
}

}  // namespace

std::string percentText(double share) {
  return fmt::format("{:.3g}%", 100.0 * share);
}

std::string knobText(const Row& row) {
  std::string text;
  for (const Param& param : row.params) {
    if (!row.isKnob(param)) continue;
    const std::string unit = row.unitOf(param.name);
    text += fmt::format("{}{} {:.4g}{}{}", text.empty() ? "" : ", ", param.name, std::get<double>(param.value),
                        unit.empty() ? "" : " ", unit);
  }
  return text;
}

std::string recommendation(const Comparison& comparison) {
  const std::vector<Row> rows = ranked(comparison.rows);
  const BestRows best = bestOf(rows);
  std::string text;
  const bool sums = std::ranges::any_of(rows, &Row::isSum);
  if (std::ranges::count(rows, sums, &Row::isSum) < 2) return "";  // nothing to choose from
  const auto isDark = [](const TruthSummary& truth) { return truth.lit == 0; };
  if (!comparison.truths.empty() && std::ranges::all_of(comparison.truths, isDark))
    return "No advice: all that the camera sees lies in shadow, which any small bias gets right\n";
  if (best.untuned != nullptr)
    text += twoLines(comparison, "Use", *best.untuned, elsewhereText(*best.untuned)) +
            equallyGood(comparison, rows, *best.untuned);
  if (best.tuned != nullptr)
    text += twoLines(comparison, "Tuned for this very picture:", *best.tuned, transferText(*best.tuned));
  return text;
}

}  // namespace gnomon
