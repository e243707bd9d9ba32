#include "lab/compare/threshold.h"

#include "base/error.h"
#include "base/suggest.h"

#include <algorithm>
#include <cmath>
#include <regex>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

namespace {

std::vector<NumberField<Row>> metrics() {
  std::vector<NumberField<Row>> fields = numberFields<Row>();
  std::erase_if(fields, [](const NumberField<Row>& field) { return !field.notes.metric; });
  return fields;
}

std::optional<NumberField<Row>> findMetric(const std::string& name) {
  for (NumberField<Row>& metric : metrics())
    if (name == metric.name) return std::move(metric);
  return std::nullopt;
}

bool means(const Threshold& threshold, const std::string& map, const std::string& bias) {
  return (threshold.map.empty() || threshold.map == map) && (threshold.bias.empty() || threshold.bias == bias);
}

// A name that is empty means any.
void checkIsOneOf(const Threshold& threshold, const char* what, const std::string& name,
                  const std::vector<std::string>& names) {
  if (name.empty() || std::ranges::find(names, name) != names.end()) return;
  throw UsageError(fmt::format("--fail-if '{}': {} '{}' is not compared; {}", threshold.text, what, name,
                               chooseFrom(name, fmt::format("{}", fmt::join(names, ", ")))));
}

}  // namespace

std::string thresholdMetrics() {
  std::string names;
  for (const NumberField<Row>& metric : metrics()) names += fmt::format("{}{}", names.empty() ? "" : ", ", metric.name);
  return names;
}

Threshold parseThreshold(const std::string& text) {
  static const std::regex form(
      R"(^\s*(?:(?:([a-z-]+)/)?([A-Za-z0-9_.-]+):)?([a-z_]+)\s*(>=|<=|>|<)\s*([0-9.eE+-]+)\s*(%?)\s*$)");
  std::smatch match;
  Threshold threshold;
  threshold.text = text;
  const std::string help =
      "write [[map/]bias:]metric>limit[%], as in 'acne>0.1%' or 'spot/adaptive:leak>0'; metrics are " +
      thresholdMetrics();
  if (!std::regex_match(text, match, form))
    throw UsageError(fmt::format("--fail-if '{}': not understood; {}", text, help));
  threshold.map = match[1];
  threshold.bias = match[2];
  threshold.metric = match[3];
  threshold.orEqual = match[4].length() == 2;
  threshold.below = match[4].str()[0] == '<';
  threshold.percent = match[6].length() == 1;
  try {
    size_t used = 0;
    threshold.limit = std::stod(match[5].str(), &used);
    if (used != match[5].str().size() || !std::isfinite(threshold.limit)) throw std::invalid_argument("");
  } catch (const std::exception&) {
    throw UsageError(fmt::format("--fail-if '{}': '{}' is not a number; {}", text, match[5].str(), help));
  }
  if (!findMetric(threshold.metric))
    throw UsageError(fmt::format("--fail-if '{}': no metric '{}'; {}", text, threshold.metric,
                                 chooseFrom(threshold.metric, thresholdMetrics())));
  if (threshold.percent && findMetric(threshold.metric)->notes.kind == NumberKind::Milliseconds)
    throw UsageError(fmt::format("--fail-if '{}': a time is in milliseconds; leave out the %", text));
  return threshold;
}

void checkMeansARow(const Threshold& threshold, const CompareOptions& options) {
  std::vector<std::string> maps, biases;
  bool meansOne = false;
  for (const Parameterization* map : options.maps) {
    maps.emplace_back(map->name());
    for (const BiasMethod* bias : optionsFor(options, *map).biases) {
      biases.emplace_back(bias->name);
      meansOne = meansOne || means(threshold, map->name(), bias->name);
    }
  }
  std::ranges::sort(biases);
  biases.erase(std::unique(biases.begin(), biases.end()), biases.end());
  checkIsOneOf(threshold, "map", threshold.map, maps);
  checkIsOneOf(threshold, "bias", threshold.bias, biases);
  if (!meansOne)
    throw UsageError(fmt::format("--fail-if '{}': a {} map is not compared with bias {}", threshold.text, threshold.map,
                                 threshold.bias));
  const bool filtered = options.filters.size() > 1 || options.filters.front()->id != glsl::kShadowFilterNone;
  if (threshold.metric == "flip" && !filtered)
    throw UsageError(fmt::format("--fail-if '{}': flip is measured with --filters only", threshold.text));
}

std::optional<std::string> crossed(const Threshold& threshold, const std::vector<Row>& rows) {
  const NumberField<Row> metric = *findMetric(threshold.metric);
  bool meansOne = false;
  for (const Row& row : rows) {
    if (!means(threshold, row.map, row.bias) || !metric.of(row)) continue;
    meansOne = true;
    double value = *metric.of(row);
    const bool pixels = metric.notes.kind == NumberKind::Count;
    if (threshold.percent) value *= pixels ? 100.0 / static_cast<double>(row.scored) : 100.0;
    const bool beyond = threshold.below ? value < threshold.limit : value > threshold.limit;
    if (beyond || (threshold.orEqual && value == threshold.limit))
      return fmt::format("{} {}: {} is {:.6g}{}, which exceeds --fail-if '{}'", row.map, row.bias, threshold.metric,
                         value, threshold.percent ? "%" : "", threshold.text);
  }
  if (!meansOne) throw UsageError(fmt::format("--fail-if '{}': no row was measured that it means", threshold.text));
  return std::nullopt;
}

}  // namespace gnomon
