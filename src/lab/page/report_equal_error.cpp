#include "lab/page/report_equal_error.h"

#include "lab/page/report_text.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

constexpr size_t kColors = 16;  // line-0 .. line-15 of the page

size_t placeOf(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

// A color a bias; maps and lights after the first are dashed.
struct Looks {
  std::vector<std::string> biases, maps;
  std::vector<size_t> color;  // of each method
  std::vector<bool> dashed;

  explicit Looks(const EqualError& equal) {
    std::vector<std::string> inOrder;  // whichever is best: the same colors for the same biases
    for (const EqualErrorMethod& method : equal.methods) inOrder.push_back(method.bias);
    std::ranges::sort(inOrder);
    for (const std::string& bias : inOrder) placeOf(biases, bias);
    for (const EqualErrorMethod& method : equal.methods) {
      color.push_back(placeOf(biases, method.bias) % kColors);
      dashed.push_back(placeOf(maps, mapText(method.map, method.light)) > 0);
    }
  }
};

std::string mapOf(const EqualErrorMethod& method, const Looks& looks) {
  const bool oneLight = std::ranges::none_of(looks.maps, [&](const std::string& map) {
    return map != mapText(method.map, method.light) && map.starts_with(method.map + ", ");
  });
  return mapText(method.map, oneLight ? "" : method.light);
}

std::string milliseconds(double ms) {
  return fmt::format("{:.2f}", ms);
}

TemplateData methodView(const EqualErrorMethod& method, const Looks& looks, size_t index) {
  const SizedError& told = method.smallest ? *method.smallest : method.sizes.back();
  TemplateData view;
  view.set("bias", method.bias);
  view.set("map", mapOf(method, looks));
  view.set("color", std::to_string(looks.color[index]));
  view.set("reached", method.smallest.has_value());
  view.set("side", std::to_string(told.mapSide));
  view.set("mebibytes", fmt::format("{:.2f}", static_cast<double>(told.mapBytes) / (1 << 20)));
  view.set("rawBytes", std::to_string(told.mapBytes));
  view.set("allWrong", percent(told.allWrong));
  view.set("rawAllWrong", rawNumber(told.allWrong));
  view.set("buildMs", milliseconds(told.buildMs));
  view.set("shadeMs", milliseconds(told.shadeMs));
  view.set("frameMs", milliseconds(told.frameMs));
  return view;
}

TemplateData legend(const EqualError& equal, const Looks& looks) {
  TemplateData list = viewList();
  for (size_t i = 0; i < equal.methods.size(); ++i) {
    TemplateData view;
    view.set("first", i == 0);
    view.set("last", i + 1 == equal.methods.size());
    view.set("color", std::to_string(looks.color[i]));
    view.set("dashed", static_cast<bool>(looks.dashed[i]));
    view.set("name", looks.maps.size() > 1
                         ? fmt::format("{}, {}", equal.methods[i].bias, mapOf(equal.methods[i], looks))
                         : equal.methods[i].bias);
    list.push_back(view);
  }
  return list;
}

enum class Cost { Megatexels, FrameMs };

double costOf(const SizedError& sized, Cost cost) {
  return cost == Cost::Megatexels ? static_cast<double>(sized.mapTexels) * 1e-6 : std::max(sized.frameMs, 1e-3);
}

TemplateData linesPlot(const EqualError& equal, const Looks& looks, Cost cost, const char* size, double width,
                       double height) {
  std::vector<PlotItem> items;
  for (const EqualErrorMethod& method : equal.methods)
    for (const SizedError& sized : method.sizes) items.push_back({"", costOf(sized, cost), sized.allWrong});
  items.push_back({"", items.empty() ? 1.0 : items.front().costMs, equal.limit});  // so that the axis holds it
  const Plot plot = layOutPlot(items, width, height, CostAxis::Logarithmic);
  TemplateData view;
  setPlotFrame(view, plot, size);
  view.set("costName", cost == Cost::Megatexels ? "million texels" : "whole frame, ms");
  view.set("limitAt", coordinate(plot.yOfError(equal.limit)));
  TemplateData curves = viewList(), points = viewList();
  size_t at = 0;
  for (size_t i = 0; i < equal.methods.size(); ++i) {
    const EqualErrorMethod& method = equal.methods[i];
    std::string path;
    for (const SizedError& sized : method.sizes) {
      const PlotMark& mark = plot.marks[at++];
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", mark.x, mark.y);
      const bool smallest = method.smallest && method.smallest->mapSide == sized.mapSide;
      TemplateData point;
      point.set("x", coordinate(mark.x));
      point.set("y", coordinate(mark.y));
      point.set("r", smallest ? "5" : "2.5");
      point.set("color", std::to_string(looks.color[i]));
      point.set("smallest", smallest);
      point.set("title", fmt::format("{}, {} {}: {} wrong, frame {:.2f} ms", method.bias, mapOf(method, looks),
                                     sized.mapSide, percent(sized.allWrong), sized.frameMs));
      points.push_back(point);
    }
    TemplateData curve;
    curve.set("color", std::to_string(looks.color[i]));
    curve.set("dashed", static_cast<bool>(looks.dashed[i]));
    curve.set("path", path);
    curves.push_back(curve);
  }
  view.set("curves", curves);
  view.set("points", points);
  return view;
}

}  // namespace

TemplateData equalErrorView(const EqualError& equal) {
  const Looks looks(equal);
  TemplateData view;
  view.set("limit", errorText(equal.limit));
  view.set("largest", std::to_string(equal.largestSide));
  TemplateData methods = viewList();
  for (size_t i = 0; i < equal.methods.size(); ++i) methods.push_back(methodView(equal.methods[i], looks, i));
  view.set("methods", methods);
  view.set("lines", legend(equal, looks));
  TemplateData plots = viewList();
  for (const Cost cost : {Cost::Megatexels, Cost::FrameMs}) {
    plots.push_back(linesPlot(equal, looks, cost, "wide", 980.0, 400.0));
    plots.push_back(linesPlot(equal, looks, cost, "narrow", 368.0, 360.0));
  }
  view.set("plots", plots);
  return view;
}

}  // namespace gnomon
