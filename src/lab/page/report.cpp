#include "lab/page/report.h"

#include "base/check.h"
#include "lab/page/media_page.h"
#include "lab/page/report_data.h"
#include "lab/page/report_page.h"
#include "lab/page/report_plot.h"
#include "lab/page/report_rows.h"
#include "lab/page/report_views.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

namespace {

constexpr int kMarkShapes = 6;  // mark-0 .. mark-5 of the page

double unsure(const ReportTruth& truth) {
  if (truth.scored == 0) return 0.0;
  return static_cast<double>(std::max(truth.flipsHalf, truth.flipsDouble)) / static_cast<double>(truth.scored);
}

double wrongShare(const ReportRow& row) {
  if (row.scored == 0) return 0.0;
  return static_cast<double>(row.acne + row.leak + row.edgeShadow + row.edgeLight) / static_cast<double>(row.scored);
}

// The share of wrong pixels that fills a bar. One method without a bias errs a hundred times more than the
// rest and would leave them no room: the scale ends at three times the median, and longer bars are cut.
double barScale(const std::vector<ReportRow>& rows) {
  std::vector<double> shares;
  for (const ReportRow& row : rows) shares.push_back(wrongShare(row));
  std::ranges::sort(shares);
  if (shares.empty() || shares.back() == 0.0) return 1.0;
  const double median = shares[shares.size() / 2];
  if (median == 0.0 || shares.back() <= 3.0 * median) return shares.back();
  return 3.0 * median;
}

bool isCut(const ReportRow& row, double scale) {
  return wrongShare(row) > scale * 1.0001;
}

View truthViews(const ReportData& data) {
  View list = viewList();
  for (const ReportTruth& truth : data.truths) {
    View view;
    view.set("map", truth.map);
    view.set("light", truth.light);
    view.set("several", data.truths.size() > 1);
    view.set("scored", grouped(truth.scored));
    view.set("lit", grouped(truth.lit));
    view.set("facingAway", grouped(truth.facingAway));
    view.set("outsideCone", grouped(truth.outsideCone));
    view.set("margin", fmt::format("{:.2g}", truth.margin));
    view.set("flipsHalf", grouped(truth.flipsHalf));
    view.set("flipsDouble", grouped(truth.flipsDouble));
    view.set("unsure", percent(unsure(truth)));
    list.push_back(view);
  }
  return list;
}

void setHead(View& page, const ReportData& data) {
  setFacts(page, data);
  page.set("gbufferMs", fmt::format("{:.2f}", data.gbufferMs));
  page.set("rowCount", fmt::format("{} {}", data.rows.size(), data.rows.size() == 1 ? "method" : "methods"));
  double worst = 0.0;
  for (const ReportTruth& truth : data.truths) worst = std::max(worst, unsure(truth));
  page.set("instrumentError", percent(worst));
  page.set("truths", truthViews(data));
  const auto any = [&](const auto& predicate) { return std::ranges::any_of(data.rows, predicate); };
  page.set("hasRows", !data.rows.empty());
  page.set("hasFilters", any([](const ReportRow& row) { return row.filter != "none"; }));
  page.set("hasUncovered", any([](const ReportRow& row) { return row.uncovered != 0; }));
  page.set("hasRmse", any([](const ReportRow& row) { return row.rmse.has_value(); }));
  page.set("hasFlip", any([](const ReportRow& row) { return row.flip.has_value(); }));
}

// What a row is held against: the truth through the row's own filter, else the truth.
ExactPictures exactPictures(const ReportData& data, const ReportRow& row, ReportPictureShelf& shelf) {
  const auto map = std::ranges::find(data.maps, row.map, &ReportMap::map);
  if (map == data.maps.end()) return {};
  for (const auto& [filter, pictures] : map->filteredTruths)
    if (filter == row.filter) return {idOf(pictures, "visibility", shelf), idOf(pictures, "beauty", shelf)};
  return {idOf(map->pictures, "truth", shelf), idOf(map->pictures, "truth_beauty", shelf)};
}

View mapView(const ReportMap& map, size_t index, ReportPictureShelf& shelf) {
  ReportPictures pictures = map.pictures;
  for (const auto& [filter, filtered] : map.filteredTruths) {
    if (filter == "none") continue;  // the truth itself
    for (const auto& [kind, path] : filtered)
      pictures.emplace_back((kind == "beauty" ? "truth_beauty " : "truth ") + filter, path);
  }
  View view;
  view.set("index", std::to_string(index));
  view.set("map", map.map);
  std::string text;
  if (map.mapSize != 0)
    text =
        fmt::format("{} × {} texels, {} layer{}. ", map.mapSize, map.mapSize, map.layers, map.layers == 1 ? "" : "s");
  if (map.zNear && map.zFar)
    text += fmt::format("Depth from {:.4g} to {:.4g} m. Near is bright.", *map.zNear, *map.zFar);
  view.set("describe", text);
  const View views = pictureViews(pictures, shelf);
  view.set("hasPictures", views.is_non_empty_list());
  view.set("pictures", views);
  return view;
}

// Marks differ by map where there are several, else by filter.
std::vector<std::string> shapeNames(const ReportData& data) {
  std::vector<std::string> maps, filters;
  const auto add = [](std::vector<std::string>& names, const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const ReportRow& row : data.rows) {
    add(maps, row.map);
    add(filters, row.filter);
  }
  return maps.size() > 1 ? maps : filters;
}

size_t shapeOf(const std::vector<std::string>& names, const ReportRow& row) {
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == row.map || names[i] == row.filter) return i % kMarkShapes;
  return 0;
}

View shapeViews(const std::vector<std::string>& names) {
  View list = viewList();
  if (names.size() < 2) return list;
  for (size_t i = 0; i < names.size(); ++i) {
    View view;
    view.set("first", i == 0);
    view.set("last", i + 1 == names.size());
    view.set("shape", std::to_string(i % kMarkShapes));
    view.set("name", names[i] == "none" ? "no filter" : names[i]);
    list.push_back(view);
  }
  return list;
}

void setFrameTicks(View& view, const Plot& plot, double gbufferMs) {
  // The frame's cost is the same axis, moved by what every row's frame has besides.
  View frames = viewList();
  const int count = static_cast<int>(plot.costTicks.size());
  for (const double ms : roundSteps(plot.costFrom + gbufferMs, plot.costTo + gbufferMs, std::max(count, 2)))
    frames.push_back(tickView({plot.xOfCost(ms - gbufferMs), fmt::format("{:g}", ms)}, plot.top - 5.0, plot.top - 9.0));
  view.set("frameTicks", frames);
}

View markView(const ReportData& data, size_t index, const PlotItem& item, const PlotMark& mark, size_t shape) {
  const ReportRow& row = data.rows[index];
  View view;
  view.set("id", rowId(index + 1));
  view.set("label", item.label);
  view.set("title", fmt::format("{}: {} bias error, build and shade {:.2f} ms, frame {:.2f} ms", rowName(data, row),
                                percent(item.error), item.costMs, row.frameMs));
  view.set("shape", std::to_string(shape));
  view.set("x", coordinate(mark.x));
  view.set("y", coordinate(mark.y));
  view.set("labelX", coordinate(mark.labelX));
  view.set("labelY", coordinate(mark.labelY));
  view.set("anchor", mark.anchor);
  view.set("onFront", mark.onFront);
  view.set("labelled", mark.labelled);
  return view;
}

View plotView(const ReportData& data, const char* size, double width, double height) {
  std::vector<PlotItem> items;
  for (const ReportRow& row : data.rows)
    items.push_back({methodName(data, row), row.buildMs + row.shadeMs, std::max(row.biasError, 0.0)});
  const Plot plot = layOutPlot(items, width, height);
  const std::vector<std::string> shapes = shapeNames(data);
  View view;
  setPlotFrame(view, plot, size);
  setFrameTicks(view, plot, data.gbufferMs);
  View front;
  front.set("path", plot.frontPath);
  view.set("front", plot.frontPath.empty() ? View(false) : front);
  View marks = viewList();
  for (const bool onFront : {false, true})  // the front is drawn over the rest
    for (size_t i = 0; i < items.size(); ++i)
      if (plot.marks[i].onFront == onFront)
        marks.push_back(markView(data, i, items[i], plot.marks[i], shapeOf(shapes, data.rows[i])));
  view.set("marks", marks);
  return view;
}

void setRows(View& page, const ReportData& data, ReportPictureShelf& shelf) {
  const double scale = barScale(data.rows);
  View rows = viewList();
  bool cut = false;
  for (size_t i = 0; i < data.rows.size(); ++i) {
    const ReportRow& row = data.rows[i];
    const ExactPictures exact = exactPictures(data, row, shelf);
    rows.push_back(rowView(row, i + 1, {.data = data, .barScale = scale, .exact = exact}, shelf));
    cut = cut || isCut(row, scale);
  }
  page.set("rows", rows);
  page.set("barScale", percent(scale));
  page.set("barsCut", cut);
  if (data.rows.empty()) {
    page.set("best", false);
    return;
  }
  View best;
  best.set("id", rowId(1));
  best.set("name", rowName(data, data.rows.front()));
  best.set("biasError", percent(data.rows.front().biasError));
  page.set("best", best);
}

}  // namespace

std::string reportHtml(const std::filesystem::path& folder) {
  const ReportData data = readReportData(folder);
  if (data.media) return mediaHtml(folder, data);
  ReportPictureShelf shelf(folder);
  View page;
  page.set("css", kPageCss);
  page.set("js", kPageJs);
  setHead(page, data);
  // Maps first: their exact pictures are what the rows are held against.
  View maps = viewList();
  for (size_t i = 0; i < data.maps.size(); ++i) maps.push_back(mapView(data.maps[i], i + 1, shelf));
  page.set("maps", maps);
  setRows(page, data, shelf);
  page.set("shapes", shapeViews(shapeNames(data)));
  View plots = viewList();
  plots.push_back(plotView(data, "wide", 980.0, 440.0));
  plots.push_back(plotView(data, "narrow", 368.0, 400.0));
  page.set("plots", plots);
  setMissing(page, shelf);

  kainjow::mustache::mustache pageTemplate{std::string(kPageHtml)};
  GNOMON_CHECK(pageTemplate.is_valid());
  return pageTemplate.render(page);
}

}  // namespace gnomon
