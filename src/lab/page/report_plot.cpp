#include "lab/page/report_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr double kTextHeight = 13.0;
constexpr double kTextWidth = 6.8;      // of a letter, on average, at 12 units' size
constexpr double kBoldTextWidth = 7.6;  // as the front's labels are
constexpr double kMarkRadius = 6.0;
constexpr double kZeroStrip = 34.0;  // below the smallest error, when there is a 0

constexpr size_t kCrowd = 24;                            // items
constexpr std::array kLabelDistances = {1.0, 1.6, 2.4};  // from the mark, in gaps, nearest first

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

void fitErrorAxis(const std::vector<PlotItem>& items, Plot& plot) {
  std::optional<double> least, most;
  for (const PlotItem& item : items) {
    if (item.error <= 0.0) continue;
    least = std::min(least.value_or(item.error), item.error);
    most = std::max(most.value_or(item.error), item.error);
  }
  if (least) {
    plot.lowestDecade = static_cast<int>(std::floor(std::log10(*least)));
    plot.highestDecade = std::max(plot.lowestDecade + 1, static_cast<int>(std::ceil(std::log10(*most))));
  } else {
    plot.lowestDecade = -4;
    plot.highestDecade = -2;
  }
  plot.errorBottom = plot.hasZero ? plot.bottom - kZeroStrip : plot.bottom;
  plot.zeroAt = plot.bottom - 12.0;
}

std::vector<PlotTick> errorTicks(const Plot& plot, ErrorText errorText) {
  std::vector<PlotTick> ticks;
  for (int exponent = plot.lowestDecade; exponent <= plot.highestDecade; ++exponent) {
    const double error = std::pow(10.0, exponent);
    ticks.push_back({plot.yOfError(error), errorText == ErrorText::Percent ? fmt::format("{:g} %", 100.0 * error)
                                                                           : fmt::format("{:g}", error)});
  }
  return ticks;
}

void fitCostAxis(const std::vector<PlotItem>& items, Plot& plot) {
  double least = 0.0;
  double most = 1.0;
  if (!items.empty()) {
    const auto [low, high] = std::ranges::minmax(items, {}, &PlotItem::costMs);
    least = low.costMs;
    most = high.costMs;
  } else if (plot.costAxis == CostAxis::Logarithmic) {
    least = 0.1;
  }
  if (plot.costAxis == CostAxis::Logarithmic) {
    const double stretch = std::max(std::pow(most / least, 0.08), 1.1);
    plot.costFrom = least / stretch;
    plot.costTo = most * stretch * stretch;
    return;
  }
  const double margin = std::max({0.08 * (most - least), 0.02 * most, 1e-3});
  plot.costFrom = std::max(0.0, least - margin);
  plot.costTo = most + 2.0 * margin;
}

// Whether `a` is better and no dearer than `b`, or cheaper and no worse; costs within the noise are equal.
bool beats(const PlotItem& a, const PlotItem& b, double noise) {
  const bool cheaper = a.costMs < (1.0 - noise) * b.costMs;
  const bool noDearer = (1.0 - noise) * a.costMs <= b.costMs;
  return (a.error < b.error && noDearer) || (a.error <= b.error && cheaper);
}

// Items that no other one beats, the cheapest first.
std::vector<size_t> findFront(const std::vector<PlotItem>& items, double noise) {
  std::vector<size_t> front;
  for (size_t i = 0; i < items.size(); ++i)
    if (std::ranges::none_of(items, [&](const PlotItem& other) { return beats(other, items[i], noise); }))
      front.push_back(i);
  std::ranges::stable_sort(front, {}, [&](size_t i) { return std::pair(items[i].costMs, -items[i].error); });
  return front;
}

// A label goes where it meets no mark, no other label and not the frame; the front's choose first.
void placeLabels(const std::vector<PlotItem>& items, Plot& plot) {
  std::vector<Box> taken;
  for (const PlotMark& mark : plot.marks)
    taken.push_back({mark.x - kMarkRadius, mark.y - kMarkRadius, mark.x + kMarkRadius, mark.y + kMarkRadius});
  std::vector<size_t> order(items.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_partition(order.begin(), order.end(), [&](size_t i) { return plot.marks[i].onFront; });
  for (const size_t i : order) {
    PlotMark& mark = plot.marks[i];
    const double width = (mark.onFront ? kBoldTextWidth : kTextWidth) * static_cast<double>(items[i].label.size());
    const auto tryAt = [&](double x, double y, const char* anchor) {
      const double x0 = *anchor == 's' ? x : *anchor == 'e' ? x - width : x - width / 2;
      const Box box{x0, y - kTextHeight + 3.0, x0 + width, y + 3.0};
      const bool inside = box.x0 > plot.left && box.x1 < plot.right && box.y0 > plot.top && box.y1 < plot.bottom;
      const bool free = std::ranges::none_of(taken, [&](const Box& b) { return b.meets(box); });
      if (mark.labelled || !inside || !free) return;
      mark.labelX = x;
      mark.labelY = y;
      mark.anchor = anchor;
      mark.labelled = true;
      taken.push_back(box);
    };
    // In a crowd a label away from its mark could be anybody's.
    for (const double away : std::span(kLabelDistances).first(items.size() > kCrowd ? 1 : kLabelDistances.size())) {
      const double gap = away * (kMarkRadius + 3.0);
      tryAt(mark.x + gap, mark.y + 4.0, "start");
      tryAt(mark.x, mark.y - gap, "middle");
      tryAt(mark.x, mark.y + gap + kTextHeight - 4.0, "middle");
      tryAt(mark.x - gap, mark.y + 4.0, "end");
      tryAt(mark.x + gap, mark.y - gap, "start");
      tryAt(mark.x + gap, mark.y + gap + 8.0, "start");
    }
    if (!mark.labelled) {  // on focus only; then it may cover others, but not leave the frame
      mark.anchor = mark.x > 0.5 * (plot.left + plot.right) ? "end" : "start";
      mark.labelX = mark.x + (*mark.anchor == 'e' ? -1.0 : 1.0) * (kMarkRadius + 3.0);
      mark.labelY = mark.y + 4.0;
    }
  }
}

}  // namespace

std::vector<double> roundSteps(double from, double to, int count) {
  const double rough = (to - from) / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double factor = rough / power;
  const double step = power * (factor < 1.5 ? 1.0 : factor < 3.5 ? 2.0 : factor < 7.5 ? 5.0 : 10.0);
  std::vector<double> steps;
  for (double i = std::ceil(from / step); i * step <= to; ++i) steps.push_back(i * step);
  return steps;
}

std::vector<double> decadeSteps(double from, double to, size_t most) {
  for (const bool all : {true, false}) {
    std::vector<double> steps;
    for (int power = static_cast<int>(std::floor(std::log10(from))); std::pow(10.0, power) <= to; ++power)
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double step = factor * std::pow(10.0, power);
        if (step >= from && step <= to && (all || factor == 1.0)) steps.push_back(step);
      }
    if (!all || steps.size() <= most) return steps;
  }
  return {};
}

double Plot::xOfCost(double costMs) const {
  const double share = costAxis == CostAxis::Logarithmic ? std::log(costMs / costFrom) / std::log(costTo / costFrom)
                                                         : (costMs - costFrom) / (costTo - costFrom);
  return left + share * (right - left);
}

double Plot::yOfError(double error) const {
  if (error <= 0.0) return zeroAt;
  return errorBottom + (std::log10(error) - lowestDecade) / (highestDecade - lowestDecade) * (top - errorBottom);
}

Plot layOutPlot(const std::vector<PlotItem>& items, double width, double height, CostAxis costAxis, ErrorText errorText,
                double costNoise) {
  Plot plot{.width = width,
            .height = height,
            .left = 62.0,
            .right = width - 14.0,
            .top = 44.0,
            .bottom = height - 44.0,
            .hasZero = std::ranges::any_of(items, [](const PlotItem& item) { return item.error <= 0.0; }),
            .costAxis = costAxis};
  fitCostAxis(items, plot);
  const bool narrow = width < 500.0;
  for (const double ms : costAxis == CostAxis::Logarithmic ? decadeSteps(plot.costFrom, plot.costTo, narrow ? 5 : 10)
                                                           : roundSteps(plot.costFrom, plot.costTo, narrow ? 4 : 7))
    plot.costTicks.push_back({plot.xOfCost(ms), fmt::format("{:g}", ms)});
  fitErrorAxis(items, plot);
  plot.errorTicks = errorTicks(plot, errorText);
  for (const PlotItem& item : items)
    plot.marks.push_back({.x = plot.xOfCost(item.costMs), .y = plot.yOfError(item.error)});
  const std::vector<size_t> front = findFront(items, costNoise);
  for (const size_t i : front) {
    PlotMark& mark = plot.marks[i];
    mark.onFront = true;
    // A step: until the dearer one is affordable, the cheaper one's error is what can be had.
    plot.frontPath += plot.frontPath.empty() ? fmt::format("M{:.1f} {:.1f}", mark.x, mark.y)
                                             : fmt::format("H{:.1f}V{:.1f}", mark.x, mark.y);
  }
  if (front.size() < 2) plot.frontPath.clear();
  placeLabels(items, plot);
  return plot;
}

}  // namespace gnomon
