#include "lab/page/report.h"

#include "base/check.h"
#include "lab/page/media_page.h"
#include "lab/page/report_equal_error.h"
#include "lab/page/report_page.h"
#include "lab/page/report_rows.h"
#include "lab/page/report_text.h"
#include "lab/results/result_folder.h"
#include "lab/results/results_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

namespace {

constexpr int kMarkShapes = 6;  // mark-0 .. mark-5 of the page

double unsure(const TruthSummary& truth) {
  if (truth.scored == 0) return 0.0;
  return static_cast<double>(std::max(truth.marginFlipsHalf, truth.marginFlipsDouble)) /
         static_cast<double>(truth.scored);
}

double wrongShare(const Row& row) {
  return row.shareOf(row.acne + row.leak + row.edge());
}

// The share of wrong pixels that fills a bar. One method without a bias errs a hundred times more than the
// rest and would leave them no room: the scale ends at three times the median, and longer bars are cut.
double barScale(const std::vector<Row>& rows) {
  std::vector<double> shares;
  for (const Row& row : rows) shares.push_back(wrongShare(row));
  std::ranges::sort(shares);
  if (shares.empty() || shares.back() == 0.0) return 1.0;
  const double median = shares[shares.size() / 2];
  if (median == 0.0 || shares.back() <= 3.0 * median) return shares.back();
  return 3.0 * median;
}

bool isCut(const Row& row, double scale) {
  return wrongShare(row) > scale * 1.0001;
}

bool hasSeveralLights(const Comparison& data) {
  return std::ranges::any_of(data.rows, &Row::isSum);
}

TemplateData truthViews(const Comparison& data) {
  TemplateData list = viewList();
  for (const TruthSummary& truth : data.truths) {
    TemplateData view;
    view.set("map", mapText(truth.map, hasSeveralLights(data) ? truth.light.name : ""));
    view.set("light", lightText(truth.light));
    view.set("several", data.truths.size() > 1);
    view.set("scored", grouped(truth.scored));
    view.set("lit", grouped(truth.lit));
    view.set("facingAway", grouped(truth.facingAway));
    view.set("outsideCone", grouped(truth.outsideCone));
    view.set("margin", fmt::format("{:.2g}", truth.margin));
    view.set("flipsHalf", grouped(truth.marginFlipsHalf));
    view.set("flipsDouble", grouped(truth.marginFlipsDouble));
    view.set("unsure", percent(unsure(truth)));
    list.push_back(view);
  }
  return list;
}

void setHead(TemplateData& page, const Comparison& data) {
  setFacts(page, data);
  page.set("gbufferMs", fmt::format("{:.2f}", data.gbufferMs));
  page.set("rowCount", fmt::format("{} {}", data.rows.size(), data.rows.size() == 1 ? "method" : "methods"));
  double worst = 0.0;
  for (const TruthSummary& truth : data.truths) worst = std::max(worst, unsure(truth));
  page.set("instrumentError", percent(worst));
  page.set("truths", truthViews(data));
  TemplateData notes = viewList();
  for (const std::string& note : data.notes) notes.push_back(TemplateData(note));
  page.set("notes", notes);
  page.set("timeNoise", errorText(data.timeNoise));
  page.set("hasRows", !data.rows.empty());
  page.set("hasFilters", std::ranges::any_of(data.rows, [](const Row& row) { return row.filter != "none"; }));
}

const char* errorName(Ranking ranking) {
  return ranking == Ranking::Rmse ? "RMSE" : "bias error";
}

std::string rankingText(const Comparison& data, const Row& row) {
  const Ranking ranking = rankingOf(data.rows);
  const double error = rankingError(ranking, row);
  return ranking == Ranking::Rmse ? fmt::format("{:.4f}", error) : percent(error);
}

const char* untunedText(const Row& row) {
  return row.isGiven ? "as given" : "at its default";
}

// What a row is held against: the truth through the row's own filter, else the truth.
ExactPictures exactPictures(const Comparison& data, const Row& row, ReportPictureShelf& shelf) {
  const auto map = std::ranges::find_if(
      data.maps, [&](const MapSummary& each) { return each.map == row.map && each.light == row.light; });
  if (map == data.maps.end()) return {};
  for (const auto& [filter, pictures] : map->filteredTruths)
    if (filter == row.filter) return {idOf(pictures, "visibility", shelf), idOf(pictures, "beauty", shelf)};
  return {idOf(map->pictures, "truth", shelf), idOf(map->pictures, "truth_beauty", shelf)};
}

TemplateData mapView(const MapSummary& map, size_t index, ReportPictureShelf& shelf) {
  Pictures pictures = map.pictures;
  for (const auto& [filter, filtered] : map.filteredTruths) {
    if (filter == "none") continue;  // the truth itself
    for (const auto& [kind, path] : filtered)
      pictures.emplace_back((kind == "beauty" ? "truth_beauty " : "truth ") + filter, path);
  }
  TemplateData view;
  view.set("index", std::to_string(index));
  view.set("map", mapText(map.map, map.light));
  std::string text;
  if (map.width != 0)
    text = fmt::format("{} × {} texels, {} slice{}. ", map.width, map.height, map.layers, map.layers == 1 ? "" : "s");
  if (map.zNear && map.zFar)
    text += fmt::format("Depth from {:.4g} to {:.4g} m. Near is bright.", shortest(*map.zNear), shortest(*map.zFar));
  view.set("describe", text);
  const TemplateData views = pictureViews(pictures, shelf);
  view.set("hasPictures", views.is_non_empty_list());
  view.set("pictures", views);
  return view;
}

// Marks differ by map where there are several, else by filter.
std::vector<std::string> shapeNames(const Comparison& data) {
  std::vector<std::string> maps, filters;
  const auto add = [](std::vector<std::string>& names, const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const Row& row : data.rows) {
    add(maps, mapText(row.map, row.light));
    add(filters, row.filter);
  }
  return maps.size() > 1 ? maps : filters;
}

size_t shapeOf(const std::vector<std::string>& names, const Row& row) {
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == mapText(row.map, row.light) || names[i] == row.filter) return i % kMarkShapes;
  return 0;
}

TemplateData shapeViews(const std::vector<std::string>& names) {
  TemplateData list = viewList();
  if (names.size() < 2) return list;
  for (size_t i = 0; i < names.size(); ++i) {
    TemplateData view;
    view.set("first", i == 0);
    view.set("last", i + 1 == names.size());
    view.set("shape", std::to_string(i % kMarkShapes));
    view.set("name", names[i] == "none" ? "no filter" : names[i]);
    list.push_back(view);
  }
  return list;
}

void setFrameTicks(TemplateData& view, const Plot& plot, double gbufferMs) {
  // The frame's cost is the same axis, moved by what every row's frame has besides.
  TemplateData frames = viewList();
  const int count = static_cast<int>(plot.costTicks.size());
  for (const double ms : roundSteps(plot.costFrom + gbufferMs, plot.costTo + gbufferMs, std::max(count, 2)))
    frames.push_back(tickView({plot.xOfCost(ms - gbufferMs), fmt::format("{:g}", ms)}, plot.top - 5.0, plot.top - 9.0));
  view.set("frameTicks", frames);
}

TemplateData markView(const Comparison& data, size_t index, const PlotItem& item, const PlotMark& mark, size_t shape) {
  const Row& row = data.rows[index];
  TemplateData view;
  view.set("id", rowId(index + 1));
  view.set("label", item.label);
  view.set("title", fmt::format("{}: {} {}, build and shade {:.2f} ms, frame {:.2f} ms", rowName(data, row),
                                errorName(rankingOf(data.rows)), rankingText(data, row), item.costMs, row.frameMs));
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

TemplateData plotView(const Comparison& data, const char* size, double width, double height) {
  std::vector<PlotItem> items;
  const Ranking ranking = rankingOf(data.rows);
  std::vector<size_t> rows;  // of several lights their sums
  for (size_t i = 0; i < data.rows.size(); ++i)
    if (data.rows[i].isSum == hasSeveralLights(data)) rows.push_back(i);
  for (const size_t i : rows)
    items.push_back({methodName(data, data.rows[i]), data.rows[i].buildMs + data.rows[i].shadeMs,
                     rankingError(ranking, data.rows[i])});
  const Plot plot = layOutPlot(items, width, height, CostAxis::Linear,
                               ranking == Ranking::Rmse ? ErrorText::Number : ErrorText::Percent, data.timeNoise);
  const std::vector<std::string> shapes = shapeNames(data);
  TemplateData view;
  view.set("errorName", errorName(ranking));
  setPlotFrame(view, plot, size);
  setFrameTicks(view, plot, data.gbufferMs);
  TemplateData front;
  front.set("path", plot.frontPath);
  view.set("front", plot.frontPath.empty() ? TemplateData(false) : front);
  TemplateData marks = viewList();
  for (const bool onFront : {false, true})  // the front is drawn over the rest
    for (size_t i = 0; i < items.size(); ++i)
      if (plot.marks[i].onFront == onFront)
        marks.push_back(markView(data, rows[i], items[i], plot.marks[i], shapeOf(shapes, data.rows[rows[i]])));
  view.set("marks", marks);
  return view;
}

// The best row that nobody tuned, and the best of those that were.
void setBest(TemplateData& page, const Comparison& data, const BestRows& best) {
  if (best.untuned == nullptr) {
    page.set("best", false);
    return;
  }
  const auto idOfRow = [&](const Row& row) { return rowId(static_cast<size_t>(&row - data.rows.data()) + 1); };
  TemplateData view;
  view.set("id", idOfRow(*best.untuned));
  view.set("name", rowName(data, *best.untuned));
  view.set("where", untunedText(*best.untuned));
  view.set("errorName", errorName(rankingOf(data.rows)));
  view.set("error", rankingText(data, *best.untuned));
  view.set("allWrong", percent(best.untuned->allWrong()));
  view.set("cost", shortNumber(best.untuned->frameMs));
  view.set("tuned", best.tuned != nullptr);
  if (best.tuned != nullptr) {
    view.set("tunedId", idOfRow(*best.tuned));
    view.set("tunedName", rowName(data, *best.tuned));
    view.set("tunedError", rankingText(data, *best.tuned));
    view.set("tunedAllWrong", percent(best.tuned->allWrong()));
  }
  page.set("best", view);
}

std::string crownOf(const BestRows& best, const Row& row) {
  if (best.untuned == &row) return std::string("best ") + untunedText(row);
  return best.tuned == &row ? "best tuned" : "";
}

bool isOneOf(const Row& row, const Row& sum) {
  return !row.isSum && row.map == sum.map && row.bias == sum.bias && row.filter == sum.filter &&
         row.isTuned() == sum.isTuned();
}

// The sums over lights in their order, each with the rows that it sums below it; and those of no sum (of a run that was
// interrupted) last.
std::vector<Row> groupedByMethod(const std::vector<Row>& rows) {
  std::vector<Row> all;
  for (const Row& sum : rows) {
    if (!sum.isSum) continue;
    all.push_back(sum);
    std::ranges::copy_if(rows, std::back_inserter(all), [&](const Row& row) { return isOneOf(row, sum); });
  }
  for (const Row& row : rows)
    if (!row.isSum && std::ranges::none_of(rows, [&](const Row& sum) { return sum.isSum && isOneOf(row, sum); }))
      all.push_back(row);
  return all;
}

// "1", "2" and so on; of rows of single lights "1.1", "1.2" under their sum's number.
std::vector<std::string> rankNames(const Comparison& data) {
  std::vector<std::string> names;
  size_t rank = 0, light = 0;
  for (const Row& row : data.rows) {
    const bool isPart = hasSeveralLights(data) && !row.isSum && rank > 0;
    if (!isPart) ++rank;
    light = isPart ? light + 1 : 0;
    names.push_back(isPart ? fmt::format("{}.{}", rank, light) : fmt::format("{}", rank));
  }
  return names;
}

void setRows(TemplateData& page, const Comparison& data, ReportPictureShelf& shelf) {
  const double scale = barScale(data.rows);
  const PageColumns<Row> columns(data.rows);
  const BestRows best = bestOf(data.rows);
  page.set("columns", columns.heads());
  page.set("byRmse", rankingOf(data.rows) == Ranking::Rmse);
  TemplateData rows = viewList();
  const std::vector<std::string> names = rankNames(data);
  bool cut = false;
  for (size_t i = 0; i < data.rows.size(); ++i) {
    const Row& row = data.rows[i];
    const ExactPictures exact = exactPictures(data, row, shelf);
    const RowContext context{.data = data,
                             .columns = columns,
                             .rank = names[i],
                             .barScale = scale,
                             .crown = crownOf(best, row),
                             .exact = exact};
    rows.push_back(rowView(row, i + 1, context, shelf));
    cut = cut || isCut(row, scale);
  }
  page.set("rows", rows);
  page.set("barScale", percent(scale));
  page.set("barsCut", cut);
  setBest(page, data, best);
}

// Best first. A light that is alone needs no name.
Comparison forPage(Comparison data) {
  data.rows = ranked(std::move(data.rows));
  if (hasSeveralLights(data)) {
    data.rows = groupedByMethod(data.rows);
    return data;
  }
  for (Row& row : data.rows) row.light.clear();
  for (MapSummary& map : data.maps) map.light.clear();
  return data;
}

std::string comparisonHtml(const std::filesystem::path& folder, const Comparison& data) {
  ReportPictureShelf shelf(folder);
  TemplateData page;
  page.set("css", kPageCss);
  page.set("js", kPageJs);
  setHead(page, data);
  // Maps first: their exact pictures are what the rows are held against.
  TemplateData maps = viewList();
  for (size_t i = 0; i < data.maps.size(); ++i) maps.push_back(mapView(data.maps[i], i + 1, shelf));
  page.set("maps", maps);
  setRows(page, data, shelf);
  page.set("shapes", shapeViews(shapeNames(data)));
  TemplateData plots = viewList();
  plots.push_back(plotView(data, "wide", 980.0, 440.0));
  plots.push_back(plotView(data, "narrow", 368.0, 400.0));
  page.set("plots", plots);
  page.set("equalError", data.equalError ? equalErrorView(*data.equalError) : TemplateData(false));
  setMissing(page, shelf);

  kainjow::mustache::mustache pageTemplate{std::string(kPageHtml)};
  GNOMON_CHECK(pageTemplate.is_valid());
  return pageTemplate.render(page);
}

}  // namespace

std::string reportHtml(const std::filesystem::path& folder) {
  const Results results = readResults(folder);
  std::visit([&](const auto& kind) { checkFiles(folder, kind.files); }, results);
  if (const auto* media = std::get_if<MediaResults>(&results)) return mediaHtml(folder, *media);
  return comparisonHtml(folder, forPage(std::get<Comparison>(results)));
}

}  // namespace gnomon
