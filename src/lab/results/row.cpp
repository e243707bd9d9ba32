#include "lab/results/row.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

std::string paramText(const Param& param) {
  return std::visit([](const auto& value) { return fmt::format("{}", value); }, param.value);
}

std::string paramText(const Params& params, const std::string& name) {
  const auto found = std::ranges::find(params, name, &Param::name);
  return found == params.end() ? "" : paramText(*found);
}

namespace {

constexpr const char* kFilterParam = "filter_";

}  // namespace

std::string filterParamName(const std::string& knob) {
  return kFilterParam + knob;
}

bool isFilterParam(const std::string& name) {
  return name.starts_with(kFilterParam);
}

double Row::shareOf(size_t pixels) const {
  return scored == 0 ? 0.0 : static_cast<double>(pixels) / static_cast<double>(scored);
}

bool Row::isKnob(const Param& param) const {
  return std::holds_alternative<double>(param.value);
}

std::string Row::unitOf(const std::string& knob) const {
  const auto found = std::ranges::find(units, knob, &NamedTexts::value_type::first);
  return found == units.end() ? "" : found->second;
}

Ranking rankingOf(const std::vector<Row>& rows) {
  return std::ranges::any_of(rows, &Row::isFiltered) ? Ranking::Rmse : Ranking::BiasError;
}

double rankingError(Ranking ranking, const Row& row) {
  return ranking == Ranking::Rmse ? row.rmse : row.biasError();
}

std::vector<Row> ranked(std::vector<Row> rows) {
  const Ranking ranking = rankingOf(rows);
  std::ranges::stable_sort(rows, {},
                           [&](const Row& row) { return std::tuple(rankingError(ranking, row), row.wrong()); });
  return rows;
}

BestRows bestOf(const std::vector<Row>& rankedRows) {
  const bool sums = std::ranges::any_of(rankedRows, &Row::isSum);
  BestRows best;
  for (const Row& row : rankedRows) {
    const Row*& place = row.isTuned() ? best.tuned : best.untuned;
    if (row.isSum == sums && place == nullptr) place = &row;
  }
  return best;
}

}  // namespace gnomon
