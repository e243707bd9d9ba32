#include "lab/table.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace gnomon {

namespace {

size_t wrongPixels(const Row& row) {
  return row.scored - row.agree;
}

std::string knobText(const Row& row) {
  std::string text;
  for (size_t i = 0; i < row.knobs.size(); ++i) {
    const std::string unit = row.knobUnits[i].empty() ? "" : " " + row.knobUnits[i];
    text += fmt::format("{}{} {:.4g}{}", i == 0 ? "" : ", ", row.knobs[i].first, row.knobs[i].second, unit);
  }
  return text;
}

}  // namespace

std::vector<Row> ranked(std::vector<Row> rows) {
  std::ranges::stable_sort(rows, {},
                           [](const Row& row) { return std::tuple(row.biasError(), wrongPixels(row)); });
  return rows;
}

std::string comparisonTable(const Comparison& comparison) {
  size_t knobWidth = 5;
  for (const Row& row : comparison.rows) knobWidth = std::max(knobWidth, knobText(row).size());
  std::string text =
      fmt::format("{:<16} {:<16} {:<{}} {:>9} {:>8} {:>8} {:>8} {:>8} {:>9} {:>10} {:>7} {:>9} {:>9}\n",
                  "map", "bias", "knobs", knobWidth, "agree", "acne", "leak", "edge_sh", "edge_li",
                  "uncovered", "bias error", "rmse", "build ms", "shade ms");
  for (const Row& row : ranked(comparison.rows)) {
    text += fmt::format(
        "{:<16} {:<16} {:<{}} {:>9} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9.4f}% {:>7.4f} {:>9.2f} {:>9.2f}\n",
        fmt::format("{} {}", row.map, row.mapSide), row.bias, knobText(row), knobWidth, row.agree, row.acne,
        row.leak, row.edgeShadow, row.edgeLight, row.uncovered, 100.0 * row.biasError(), row.rmse,
        row.buildMs, row.shadeMs);
  }
  return text;
}

std::string comparisonHeader(const Session& session, const Comparison& comparison) {
  std::string text = fmt::format("{}: {} triangles, diagonal {:.4g} m; camera '{}', {} x {}; {}\n",
                                 session.scene().name, triangleCount(session.scene()),
                                 computeBounds(session.scene()).diagonal(), session.camera().name,
                                 session.view().width, session.view().height, session.device().info().name);
  for (const TruthSummary& truth : comparison.truths) {
    const double flips = static_cast<double>(std::max(truth.marginFlipsHalf, truth.marginFlipsDouble));
    text += fmt::format(
        "{} map of light '{}': {} pixels scored ({} lit), {} face away, {} outside the cone; instrument "
        "error {:.4f}% "
        "(margin {:.2g} m halved {}, doubled {})\n",
        truth.map, truth.lightName, truth.scored, truth.lit, truth.facingAway, truth.outsideCone,
        100.0 * flips / static_cast<double>(truth.scored), truth.margin, truth.marginFlipsHalf,
        truth.marginFlipsDouble);
  }
  return text;
}

}  // namespace gnomon
