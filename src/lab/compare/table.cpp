#include "lab/compare/table.h"

#include "lab/compare/recommendation.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

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

// The row of a bias on a map through a filter (of all lights together).
const Row* findRow(const Comparison& comparison, const std::string& map, const std::string& filter,
                   const std::string& bias, bool tuned) {
  for (const Row& row : comparison.rows)
    if (row.map == map && row.filter == filter && row.bias == bias && row.isTuned() == tuned &&
        row.isSum == hasSums(comparison))
      return &row;
  return nullptr;
}

// How many times as wrong the rival is, by acne and leak, or of filtered rows by RMSE.
std::string factorText(const Row& rival, const Row& row) {
  const bool filtered = row.isFiltered();
  const double theirs = filtered ? rival.rmse : static_cast<double>(rival.acne + rival.leak);
  const double mine = filtered ? row.rmse : static_cast<double>(row.acne + row.leak);
  return mine > 0.0 ? fmt::format("{:.2f}", theirs / mine) : theirs > 0.0 ? "infinite" : "1, both none";
}

std::string errorText(const Row& row) {
  return row.isFiltered() ? fmt::format("RMSE {:.4f}", row.rmse) : fmt::format("{} wrong pixels", row.acne + row.leak);
}

// "cube: adaptive 40 wrong pixels, tuned constant 120 wrong pixels (factor 3.00)". More than 1: better.
std::string factorLines(const Comparison& comparison, const std::string& map, const std::string& filter) {
  std::string text;
  for (const char* bias : {"dual", "adaptive", kDefaultBias}) {
    for (const bool tuned : {false, true}) {
      const Row* row = findRow(comparison, map, filter, bias, tuned);
      for (const char* rivalName : {"constant", "slope"}) {
        const Row* rival = findRow(comparison, map, filter, rivalName, true);
        if (row == nullptr || rival == nullptr) continue;
        text += fmt::format("{}: {}{} {}, tuned {} {} (factor {})\n", map, biasText(*row),
                            row->isFiltered() ? ", " + filter + "," : "", errorText(*row), rivalName, errorText(*rival),
                            factorText(*rival, *row));
      }
    }
  }
  return text;
}

std::string factorLines(const Comparison& comparison) {
  std::string text;
  std::vector<std::pair<std::string, std::string>> told;
  for (const Row& row : comparison.rows) {
    const std::pair both(row.map, row.filter);
    if (std::ranges::find(told, both) != told.end()) continue;
    told.push_back(both);
    text += factorLines(comparison, row.map, row.filter);
  }
  return text;
}

// The columns of text to the left of the numbers, each as wide as its widest cell.
class TextColumns {
 public:
  void add(std::vector<std::string> cells) {  // the first one is the head
    columns_.push_back(std::move(cells));
    widths_.push_back(std::ranges::max(columns_.back(), {}, &std::string::size).size());
  }
  size_t width() const {
    size_t sum = widths_.size() - 1;
    for (const size_t width : widths_) sum += width;
    return sum;
  }
  // Of the last column, down to its head.
  void shortenBy(size_t letters) {
    const size_t least = std::max(columns_.back().front().size(), size_t{12});
    if (widths_.back() > least) widths_.back() -= std::min(letters, widths_.back() - least);
  }
  std::string line(size_t i) const {
    std::string text;
    for (size_t c = 0; c < columns_.size(); ++c) {
      std::string cell = columns_[c][i];
      if (cell.size() > widths_[c]) cell = cell.substr(0, widths_[c] - 2) + "..";
      text += fmt::format("{}{:<{}}", c == 0 ? "" : " ", cell, widths_[c]);
    }
    return text;
  }

 private:
  std::vector<std::vector<std::string>> columns_;
  std::vector<size_t> widths_;
};

TextColumns textColumns(const Comparison& comparison, const std::vector<Row>& rows) {
  std::vector<std::string> maps{"map"}, biases{"bias"}, filters{"filter"}, knobs{"parameters"};
  for (const Row& row : rows) {
    maps.push_back(mapText(comparison, row));
    biases.push_back(biasText(row));
    filters.push_back(row.filter);
    knobs.push_back(knobText(row));
  }
  TextColumns columns;
  columns.add(std::move(maps));
  columns.add(std::move(biases));
  if (std::ranges::any_of(rows, &Row::isFiltered)) columns.add(std::move(filters));
  columns.add(std::move(knobs));
  return columns;
}

}  // namespace

std::string comparisonTable(const Comparison& comparison, const TableLayout& layout) {
  std::vector<Row> rows = ranked(comparison.rows);
  // Of several lights their sums; each is in the report.
  std::erase_if(rows, [&](const Row& row) { return row.isSum != hasSums(comparison); });
  if (rows.empty()) return "";
  TextColumns texts = textColumns(comparison, rows);
  const char* kept = rankingOf(rows) == Ranking::Rmse ? "rmse" : "";
  int from = layout.wide ? kWideOnly + 1 : kWideOnly;
  DeclaredColumns<Row> numbers(rows, from, kept);
  if (!layout.wide && layout.width > 0) {
    while (from > 1 && texts.width() + numbers.head().size() > layout.width)
      numbers = DeclaredColumns<Row>(rows, --from, kept);
    const size_t length = texts.width() + numbers.head().size();
    if (length > layout.width) texts.shortenBy(length - layout.width);
  }
  std::string text = texts.line(0) + numbers.head() + "\n";
  for (size_t i = 0; i < rows.size(); ++i) text += texts.line(i + 1) + numbers.line(rows[i]) + "\n";
  return text;
}

std::string tuningTable(const Comparison& comparison) {
  std::string text;
  const auto error = [](double biasError, std::optional<double> rmse) {
    return rmse ? fmt::format("{:.4f}", *rmse) : fmt::format("{:.4f}%", 100.0 * biasError);
  };
  for (const Row& row : comparison.rows) {
    if (!row.tuning || row.isSum) continue;
    const Tuning& tuning = *row.tuning;
    text += fmt::format("tuned {}{} {}{}: {}{} after {} evaluations; {} {}", row.map,
                        hasSums(comparison) ? ", " + row.light + "," : "", row.bias,
                        row.isFiltered() ? ", " + row.filter : "", knobText(row),
                        tuning.atEnd.empty() ? "" : fmt::format(" (the {} end of what was tried)", tuning.atEnd),
                        tuning.evaluations, row.isFiltered() ? "RMSE" : "bias error",
                        error(row.biasError(), row.isFiltered() ? std::optional(row.rmse) : std::nullopt));
    const auto add = [&](const std::string& where, const Transfer& there) {
      text += fmt::format("; {} {} (best there {})", where, error(there.biasError, there.rmse),
                          error(there.bestBiasError, there.bestRmse));
    };
    if (tuning.otherCamera) add("camera " + tuning.otherCamera->camera, *tuning.otherCamera);
    if (tuning.otherMapSize) add(fmt::format("map of {}", tuning.otherMapSize->mapSize), *tuning.otherMapSize);
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
    text += fmt::format(
        "{} map of light '{}': {} pixels face the light and are scored, {} of them lit; not scored: {} that face away, "
        "{} "
        "outside a spot's cone; with half or twice the exact shadow's margin ({:.2g} m) {} or {} pixels change\n",
        truth.map, truth.light.name, truth.scored, truth.lit, truth.facingAway, truth.outsideCone, truth.margin,
        truth.marginFlipsHalf, truth.marginFlipsDouble);
    if (!truth.fitNote.empty()) text += truth.fitNote + "\n";
  }
  std::string last;
  for (const MapSummary& map : comparison.maps) {
    if (!map.solidAngles || map.map == last) continue;
    last = map.map;
    text += fmt::format(
        "{} map, {} x {} x {} texels: each sees {:.3g} to {:.3g} steradians (the largest {:.2f} times the smallest)\n",
        map.map, map.layers, map.width, map.height, map.solidAngles->smallest, map.solidAngles->largest,
        map.solidAngles->largest / map.solidAngles->smallest);
  }
  for (const std::string& note : comparison.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace gnomon
