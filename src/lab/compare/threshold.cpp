#include "lab/compare/threshold.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr std::array kMetrics = {"acne", "leak",      "edge_shadow", "edge_light",
                                 "edge", "uncovered", "bias_error",  "rmse"};

double metricOf(const Row& row, const std::string& metric) {
  if (metric == "acne") return static_cast<double>(row.acne);
  if (metric == "leak") return static_cast<double>(row.leak);
  if (metric == "edge_shadow") return static_cast<double>(row.edgeShadow);
  if (metric == "edge_light") return static_cast<double>(row.edgeLight);
  if (metric == "edge") return static_cast<double>(row.edgeShadow + row.edgeLight);
  if (metric == "uncovered") return static_cast<double>(row.uncovered);
  return metric == "rmse" ? row.rmse : row.biasError();
}

bool isShare(const std::string& metric) {
  return metric == "bias_error" || metric == "rmse";
}

}  // namespace

Threshold parseThreshold(const std::string& text) {
  static const std::regex form(
      R"(^\s*(?:(?:([a-z-]+)/)?([a-z0-9-]+):)?([a-z_]+)\s*(>=|<=|>|<)\s*([0-9.eE+-]+)\s*(%?)\s*$)");
  std::smatch match;
  Threshold threshold;
  threshold.text = text;
  const char* help =
      "write [[map/]bias:]metric>limit[%], as in 'acne>0.1%' or 'spot/adaptive:leak>0'; metrics are acne, "
      "leak, "
      "edge_shadow, edge_light, edge, uncovered, bias_error, rmse";
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
    throw UsageError(fmt::format("--fail-if '{}': '{}' is no number; {}", text, match[5].str(), help));
  }
  if (std::ranges::find(kMetrics, threshold.metric) == kMetrics.end())
    throw UsageError(fmt::format("--fail-if '{}': no metric '{}'; {}", text, threshold.metric, help));
  return threshold;
}

std::optional<std::string> crossed(const Threshold& threshold, const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    if (!threshold.map.empty() && threshold.map != row.map) continue;
    if (!threshold.bias.empty() && threshold.bias != row.bias) continue;
    double value = metricOf(row, threshold.metric);
    if (threshold.percent) value *= isShare(threshold.metric) ? 100.0 : 100.0 / static_cast<double>(row.scored);
    const bool beyond = threshold.below ? value < threshold.limit : value > threshold.limit;
    if (beyond || (threshold.orEqual && value == threshold.limit))
      return fmt::format("{} {}: {} is {:.6g}{}, which crosses --fail-if '{}'", row.map, row.bias, threshold.metric,
                         value, threshold.percent ? "%" : "", threshold.text);
  }
  return std::nullopt;
}

}  // namespace gnomon
