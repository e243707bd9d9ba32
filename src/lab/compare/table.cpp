#include "lab/compare/table.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

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

std::string biasText(const Row& row) {
  return row.bias + (row.tuning ? " (tuned)" : "");
}

bool hasSums(const Comparison& comparison) {
  return std::ranges::any_of(comparison.rows, &Row::isSum);
}

// "cube 1024", and the light where there are several.
std::string mapText(const Comparison& comparison, const Row& row) {
  return fmt::format("{} {}{}", row.map, row.mapDimensions, hasSums(comparison) ? ", " + row.light : "");
}

// The row of a bias on a map (of all lights together), unfiltered counts being the same for all filters.
const Row* findRow(const Comparison& comparison, const std::string& map, const std::string& bias, bool tuned) {
  for (const Row& row : comparison.rows)
    if (row.map == map && row.bias == bias && row.tuning.has_value() == tuned && row.isSum == hasSums(comparison))
      return &row;
  return nullptr;
}

// "adaptive (default) against the best constant: 120 / 40 = 3.0". More than 1: better.
std::string factorLines(const Comparison& comparison) {
  std::string text;
  std::vector<std::string> told;
  for (const MapSummary& map : comparison.maps) {
    if (std::ranges::find(told, map.map) != told.end()) continue;
    told.push_back(map.map);
    for (const char* bias : {"dual", "adaptive"}) {
      for (const bool tuned : {false, true}) {
        const Row* row = findRow(comparison, map.map, bias, tuned);
        for (const char* rivalName : {"constant", "slope"}) {
          const Row* rival = findRow(comparison, map.map, rivalName, true);
          if (row == nullptr || rival == nullptr) continue;
          const size_t mine = row->acne + row->leak, theirs = rival->acne + rival->leak;
          const std::string factor =
              mine > 0     ? fmt::format("{:.2f}", static_cast<double>(theirs) / static_cast<double>(mine))
              : theirs > 0 ? std::string("infinite")
                           : std::string("1 (both none)");
          text += fmt::format("{} {} against the tuned {}: {} / {} wrong pixels = {}\n", map.map, biasText(*row),
                              rivalName, theirs, mine, factor);
        }
      }
    }
  }
  return text;
}

}  // namespace

std::string comparisonTable(const Comparison& comparison) {
  size_t knobWidth = 5, mapWidth = 16;
  for (const Row& row : comparison.rows) {
    knobWidth = std::max(knobWidth, knobText(row).size());
    mapWidth = std::max(mapWidth, mapText(comparison, row).size());
  }
  const DeclaredColumns<Row> columns(comparison.rows);
  const auto line = [&](const std::string& map, const std::string& bias, const std::string& filter,
                        const std::string& knobs, const std::string& numbers) {
    return fmt::format("{:<{}} {:<25} {:<9} {:<{}}{}\n", map, mapWidth, bias, filter, knobs, knobWidth, numbers);
  };
  std::string text = line("map", "bias", "filter", "parameters", columns.head());
  for (const Row& row : ranked(comparison.rows)) {
    if (row.isSum != hasSums(comparison)) continue;  // of several lights their sums; each is in the report
    text += line(mapText(comparison, row), biasText(row), row.filter, knobText(row), columns.line(row));
  }
  return text;
}

std::string tuningTable(const Comparison& comparison) {
  std::string text;
  for (const Row& row : comparison.rows) {
    if (!row.tuning || row.isSum || row.filter != comparison.rows.front().filter) continue;
    const Tuning& tuning = *row.tuning;
    text += fmt::format("tuned {} {}: {} after {} evaluations; bias error {:.4f}%", row.map, row.bias, knobText(row),
                        tuning.evaluations, 100.0 * row.biasError());
    if (tuning.otherCamera)
      text += fmt::format("; camera {} {:.4f}% (best there {:.4f}%)", tuning.otherCamera->camera,
                          100.0 * tuning.otherCamera->biasError, 100.0 * tuning.otherCamera->bestBiasError);
    if (tuning.otherMapSize)
      text += fmt::format("; map of {} {:.4f}% (best there {:.4f}%)", tuning.otherMapSize->mapSize,
                          100.0 * tuning.otherMapSize->biasError, 100.0 * tuning.otherMapSize->bestBiasError);
    text += "\n";
  }
  return text + factorLines(comparison);
}

std::string comparisonHeader(const Session& session, const Comparison& comparison) {
  std::string text =
      fmt::format("{}: {} triangles, diagonal {:.4g} m; camera '{}', {} x {}; {}\n", session.scene().name,
                  triangleCount(session.scene()), computeBounds(session.scene()).diagonal(), session.camera().name,
                  session.view().width, session.view().height, session.device().info().name);
  for (const TruthSummary& truth : comparison.truths) {
    const double flips = static_cast<double>(std::max(truth.marginFlipsHalf, truth.marginFlipsDouble));
    text += fmt::format(
        "{} map of light '{}': {} pixels scored ({} lit), {} face away, {} outside the cone; instrument "
        "error {:.4f}% "
        "(margin {:.2g} m halved {}, doubled {})\n",
        truth.map, truth.light.name, truth.scored, truth.lit, truth.facingAway, truth.outsideCone,
        100.0 * flips / static_cast<double>(truth.scored), truth.margin, truth.marginFlipsHalf,
        truth.marginFlipsDouble);
    if (!truth.fitNote.empty()) text += truth.fitNote + "\n";
  }
  std::string last;
  for (const MapSummary& map : comparison.maps) {
    if (!map.solidAngles || map.map == last) continue;
    last = map.map;
    text += fmt::format("{} map, {} x {} x {} texels: from {:.3g} to {:.3g} steradians, 1 to {:.2f}\n", map.map,
                        map.layers, map.width, map.height, map.solidAngles->smallest, map.solidAngles->largest,
                        map.solidAngles->largest / map.solidAngles->smallest);
  }
  return text;
}

}  // namespace gnomon
