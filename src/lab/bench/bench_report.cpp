#include "lab/bench/bench.h"
#include "lab/core/results_head.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

// Cost of a stage as a power of the size, over the curve's upper half: 1 is in proportion to it.
double exponentOf(const Growth& growth, size_t stage, std::vector<double> Growth::Point::*times) {
  if (growth.points.size() < 2) return 0.0;
  const Growth::Point& last = growth.points.back();
  const Growth::Point& middle = growth.points[(growth.points.size() - 1) / 2];
  return std::log((last.*times)[stage] / (middle.*times)[stage]) / std::log(last.size / middle.size);
}

std::string growthTable(const Growth& growth) {
  std::string text = fmt::format(
      "\n"
      "scaling with {} ({}), ms of wall clock; exponents over the upper half of the sizes\n"
      "{:<28}",
      growth.size, growth.unit, "");
  for (const Growth::Point& point : growth.points) text += fmt::format("{:>15}", point.name);
  text += fmt::format("{:>10}{:>8}\n", "exponent", "of cpu");
  for (size_t stage = 0; stage < growth.stages.size(); ++stage) {
    text += fmt::format("{:<28}", growth.stages[stage]);
    for (const Growth::Point& point : growth.points) text += fmt::format("{:>15.2f}", point.ms[stage]);
    text += fmt::format("{:>10.2f}{:>8.2f}\n", exponentOf(growth, stage, &Growth::Point::ms),
                        exponentOf(growth, stage, &Growth::Point::cpuMs));
  }
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

// Okabe and Ito's colours, which people who see few colours tell apart; as in the label maps.
constexpr std::array kLineColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"};

// One curve diagram with its corner at (x, y).
class Diagram {
 public:
  static constexpr double kWidth = 520.0, kHeight = 360.0;

  Diagram(const Growth& growth, double x, double y) : growth_(growth), x_(x + 60.0), y_(y + 34.0) {
    for (const Growth::Point& point : growth.points) {
      sizeFrom_ = std::min(sizeFrom_, point.size);
      sizeTo_ = std::max(sizeTo_, point.size);
      for (const double ms : point.ms) {
        msFrom_ = std::min(msFrom_, ms);
        msTo_ = std::max(msTo_, ms);
      }
    }
    msFrom_ = std::pow(10.0, std::floor(std::log10(msFrom_)));
    msTo_ = std::pow(10.0, std::ceil(std::log10(msTo_)));
  }

  std::string svg() const {
    std::string text = fmt::format("<text x='{:.0f}' y='{:.0f}' font-weight='bold'>milliseconds against {}</text>\n",
                                   x_, y_ - 14.0, escaped(growth_.size));
    for (double ms = msFrom_; ms <= msTo_ * 1.01; ms *= 10.0)
      text += fmt::format(
          "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='#ccc'/><text x='{:.1f}' y='{:.1f}' "
          "text-anchor='end'>{:g}</text>\n",
          x_, yOf(ms), x_ + kPlotWidth, yOf(ms), x_ - 6.0, yOf(ms) + 4.0, ms);
    // Long names of near sizes stand in two rows.
    for (size_t i = 0; i < growth_.points.size(); ++i)
      text += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle' font-size='10'>{}</text>\n",
                          xOf(growth_.points[i].size), y_ + kPlotHeight + (i % 2 == 0 ? 14.0 : 25.0),
                          escaped(growth_.points[i].name));
    for (size_t stage = 0; stage < growth_.stages.size(); ++stage) text += curve(stage);
    return text;
  }

 private:
  static constexpr double kPlotWidth = 430.0, kPlotHeight = 210.0;

  double xOf(double size) const {
    return x_ + kPlotWidth * std::log(size / sizeFrom_) / std::max(std::log(sizeTo_ / sizeFrom_), 1e-9);
  }
  double yOf(double ms) const { return y_ + kPlotHeight * (1.0 - std::log(ms / msFrom_) / std::log(msTo_ / msFrom_)); }
  std::string curve(size_t stage) const {
    const char* color = kLineColors[stage % kLineColors.size()];
    std::string path;
    for (const Growth::Point& point : growth_.points)
      path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "M" : " L", xOf(point.size), yOf(point.ms[stage]));
    const double legendX = x_ + 215.0 * static_cast<double>(stage % 2);
    const double legendY = y_ + kPlotHeight + 48.0 + 18.0 * static_cast<double>(stage / 2);
    return fmt::format(
        "<path d='{}' fill='none' stroke='{}' stroke-width='2'/><line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' "
        "y2='{:.1f}' stroke='{}' stroke-width='3'/><text x='{:.1f}' y='{:.1f}'>{}</text>\n",
        path, color, legendX, legendY - 4.0, legendX + 18.0, legendY - 4.0, color, legendX + 24.0, legendY,
        escaped(growth_.stages[stage]));
  }

  const Growth& growth_;
  double x_, y_;
  double sizeFrom_ = 1e300, sizeTo_ = 0.0, msFrom_ = 1e300, msTo_ = 0.0;
};

}  // namespace

std::string benchTable(const Session& session, const Bench& bench) {
  std::string text = fmt::format(
      "{}: {} triangles; camera '{}', {} x {}; {}\n"
      "ratio: this stage's time / the other stage's time in the same round, median over the rounds; cpu: processor "
      "time of all threads\n"
      "{:<44}{:>10}{:>10}{:>10}{:>8}{:>10}{:>8}  {}\n",
      session.scene().name, triangleCount(session.scene()), session.camera().name, session.view().width,
      session.view().height, session.device().info().name, "stage", "median ms", "min", "max", "ratio", "cpu ms",
      "ratio", "to");
  for (const StageCost& stage : bench.stages) {
    const auto told = [&](double ratio) { return stage.ratioTo.empty() ? "" : fmt::format("{:.2f}", ratio); };
    text += fmt::format("{:<44}{:>10.2f}{:>10.2f}{:>10.2f}{:>8}{:>10.2f}{:>8}  {}\n", stage.name, stage.medianMs,
                        stage.minMs, stage.maxMs, told(stage.ratio), stage.cpuMs, told(stage.cpuRatio), stage.ratioTo);
  }
  for (const Growth& growth : bench.growths) text += growthTable(growth);
  if (bench.start)
    text += fmt::format(
        "\n"
        "from typing `gnomon render` to the picture: {:.0f} ms with all caches empty, {:.0f} ms with them filled\n",
        bench.start->coldMs, bench.start->warmMs);
  return text;
}

std::string benchJson(const Session& session, const Bench& bench, const std::string& command) {
  Json json;
  json["gnomon"] = {{"version", gnomonVersion()},
                    {"device", session.device().info().name},
                    {"driver", session.device().info().driver},
                    {"command", command}};
  json["scene"] = {{"name", session.scene().name}, {"triangles", triangleCount(session.scene())}};
  json["picture"] = {{"width", session.view().width}, {"height", session.view().height}};
  json["stages"] = Json::array();
  for (const StageCost& stage : bench.stages) {
    Json entry = {{"name", stage.name},
                  {"median_ms", stage.medianMs},
                  {"min_ms", stage.minMs},
                  {"max_ms", stage.maxMs},
                  {"cpu_ms", stage.cpuMs}};
    if (!stage.ratioTo.empty())
      entry.update({{"ratio", stage.ratio}, {"cpu_ratio", stage.cpuRatio}, {"ratio_to", stage.ratioTo}});
    json["stages"].push_back(entry);
  }
  json["growth"] = Json::array();
  for (const Growth& growth : bench.growths) {
    Json points = Json::array();
    for (const Growth::Point& point : growth.points)
      points.push_back({{"size", point.size}, {"name", point.name}, {"ms", point.ms}, {"cpu_ms", point.cpuMs}});
    std::vector<double> exponents, cpuExponents;
    for (size_t stage = 0; stage < growth.stages.size(); ++stage) {
      exponents.push_back(exponentOf(growth, stage, &Growth::Point::ms));
      cpuExponents.push_back(exponentOf(growth, stage, &Growth::Point::cpuMs));
    }
    Json entry;
    entry["size"] = growth.size;
    entry["unit"] = growth.unit;
    entry["stages"] = growth.stages;
    entry["exponents"] = exponents;
    entry["cpu_exponents"] = cpuExponents;
    entry["points"] = points;
    json["growth"].push_back(entry);
  }
  if (bench.start) json["start"] = {{"cold_ms", bench.start->coldMs}, {"warm_ms", bench.start->warmMs}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string growthSvg(const std::vector<Growth>& growths) {
  if (growths.empty()) return {};
  const size_t rows = (growths.size() + 1) / 2;
  std::string text = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {:.0f} {:.0f}' font-family='sans-serif' "
      "font-size='12'>\n<rect width='100%' height='100%' fill='white'/>\n",
      2.0 * Diagram::kWidth, static_cast<double>(rows) * Diagram::kHeight);
  for (size_t i = 0; i < growths.size(); ++i)
    text +=
        Diagram(growths[i], Diagram::kWidth * static_cast<double>(i % 2), Diagram::kHeight * static_cast<double>(i / 2))
            .svg();
  return text + "</svg>\n";
}

}  // namespace gnomon
