#include "lab/compare/threshold.h"

#include "base/error.h"

#include <cmath>
#include <regex>

#include <fmt/format.h>

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

}  // namespace

std::string thresholdMetrics() {
  std::string names;
  for (const NumberField<Row>& metric : metrics()) names += fmt::format("{}{}", names.empty() ? "" : ", ", metric.name);
  return names;
}

Threshold parseThreshold(const std::string& text) {
  static const std::regex form(
      R"(^\s*(?:(?:([a-z-]+)/)?([a-z0-9-]+):)?([a-z_]+)\s*(>=|<=|>|<)\s*([0-9.eE+-]+)\s*(%?)\s*$)");
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
    throw UsageError(fmt::format("--fail-if '{}': no metric '{}'; {}", text, threshold.metric, help));
  return threshold;
}

std::optional<std::string> crossed(const Threshold& threshold, const std::vector<Row>& rows) {
  const NumberField<Row> metric = *findMetric(threshold.metric);
  for (const Row& row : rows) {
    if (!threshold.map.empty() && threshold.map != row.map) continue;
    if (!threshold.bias.empty() && threshold.bias != row.bias) continue;
    double value = metric.of(row).value_or(0.0);
    const bool pixels = metric.notes.kind == NumberKind::Count;
    if (threshold.percent) value *= pixels ? 100.0 / static_cast<double>(row.scored) : 100.0;
    const bool beyond = threshold.below ? value < threshold.limit : value > threshold.limit;
    if (beyond || (threshold.orEqual && value == threshold.limit))
      return fmt::format("{} {}: {} is {:.6g}{}, which exceeds --fail-if '{}'", row.map, row.bias, threshold.metric,
                         value, threshold.percent ? "%" : "", threshold.text);
  }
  return std::nullopt;
}

}  // namespace gnomon
