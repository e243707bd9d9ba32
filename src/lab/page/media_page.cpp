#include "lab/page/media_page.h"

#include "base/check.h"
#include "lab/page/report_page.h"
#include "lab/page/report_views.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace gnomon {

namespace {

std::string raw(double value) {
  return fmt::format("{}", value);
}

// Three digits: errors here run from 0.1 % to many times the mean.
std::string share(double fraction) {
  return fmt::format("{:.3g}\u202f%", 100.0 * fraction);
}

void setNumber(View& view, const std::string& name, const std::optional<double>& value, const std::string& text) {
  view.set(name, value ? text : "–");
  view.set(name + "Raw", value ? raw(*value) : "");
}

std::string factorText(const MediaDataFactor& factor) {
  const char* sign = factor.bound == "at_least" ? "≥ " : factor.bound == "at_most" ? "≤ " : "";
  return fmt::format("{}{:.3g}", sign, factor.factor);
}

const MediaDataTerms* findTerms(const MediaData& media, const std::string& method, bool withBuild,
                                const char* measure) {
  for (const MediaDataTerms& terms : media.terms)
    if (terms.method == method && terms.withBuild == withBuild && terms.measure == measure) return &terms;
  return nullptr;
}

View pair(const std::string& key, const std::string& value) {
  View view;
  view.set("key", key);
  view.set("value", value);
  return view;
}

View paramViews(const MediaDataRow& row) {
  View list = viewList();
  list.push_back(pair("map", row.map));
  if (row.steps) list.push_back(pair("steps", std::to_string(*row.steps)));
  for (const ReportParam& param : row.params) list.push_back(pair(param.name, param.text));
  return list;
}

// Medium first: it is what the methods differ in.
View stockViews(const MediaDataRow& row, ReportPictureShelf& shelf) {
  ReportPictures pictures;
  for (const char* kind : {"medium", "beauty", "difference"})
    for (const auto& [name, path] : row.pictures)
      if (name == kind) pictures.emplace_back(name, path);
  return pictureViews(pictures, shelf);
}

View rowView(const MediaDataRow& row, size_t rank, const MediaData& media, const ReportData& data,
             ReportPictureShelf& shelf) {
  View view;
  view.set("id", rowId(rank));
  view.set("rank", std::to_string(rank));
  view.set("open", rank == 1);
  view.set("name", row.name());
  view.set("map", row.map);
  for (const auto& [name, value] :
       {std::pair{"relRmse", row.relRmse}, {"relRmse99", row.relRmse99}, {"flicker", row.flicker}})
    setNumber(view, name, value, share(value.value_or(0.0)));
  setNumber(view, "flip", row.flip, fmt::format("{:.4f}", row.flip.value_or(0.0)));
  for (const auto& [name, ms] : {std::pair{"mapMs", row.mapMs},
                                 {"tableMs", row.tableMs},
                                 {"integrateMs", row.integrateMs},
                                 {"totalMs", row.totalMs()}})
    setNumber(view, name, ms, fmt::format("{:.2f}", ms));
  view.set("width", std::to_string(data.width));
  view.set("height", std::to_string(data.height));
  const auto reference = [&](const char* name, const char* kind) {
    const std::string id = media.reference ? idOf(media.reference->pictures, kind, shelf) : "";
    view.set(name, id.empty() ? View(false) : View(id));
  };
  reference("exactMedium", "medium");
  reference("exactBeauty", "beauty");
  const View pictures = stockViews(row, shelf);
  view.set("pictures", pictures);
  view.set("hasPictures", pictures.is_non_empty_list());
  view.set("params", paramViews(row));
  return view;
}

// One line a method, with and without its builds.
View termsViews(const MediaData& media) {
  View list = viewList();
  for (const MediaDataRow& row : media.rows) {
    for (const bool withBuild : {true, false}) {
      View view;
      view.set("method", row.name());
      view.set("counts", withBuild ? "map, table and integral" : "the integral alone");
      bool any = false;
      for (const auto& [measure, faster, better] :
           {std::tuple{"rel_rmse", "faster", "better"}, {"rel_rmse_99", "faster99", "better99"}}) {
        const MediaDataTerms* terms = findTerms(media, row.name(), withBuild, measure);
        view.set(faster, terms != nullptr ? factorText(terms->faster) : "–");
        view.set(better, terms != nullptr ? factorText(terms->better) : "–");
        any = any || terms != nullptr;
      }
      if (any) list.push_back(view);
    }
  }
  return list;
}

// A row without an error has no mark.
struct PlottedRow {
  size_t row = 0;
  PlotItem item;
};

std::vector<PlottedRow> plottedRows(const MediaData& media, std::optional<double> MediaDataRow::*error) {
  std::vector<PlottedRow> rows;
  for (size_t i = 0; i < media.rows.size(); ++i)
    if (const MediaDataRow& row = media.rows[i]; row.*error && row.totalMs() > 0.0)
      rows.push_back({i, {row.name(), row.totalMs(), *(row.*error)}});
  return rows;
}

// The march's marks, joined: one method at growing cost.
std::string marchPath(const MediaData& media, const std::vector<PlottedRow>& rows, const Plot& plot) {
  std::string path;
  size_t joined = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (media.rows[rows[i].row].integrator != "march") continue;
    path += fmt::format("{}{:.1f} {:.1f}", joined++ == 0 ? "M" : "L", plot.marks[i].x, plot.marks[i].y);
  }
  return joined < 2 ? "" : path;
}

View plotView(const MediaData& media, const char* size, double width, double height,
              std::optional<double> MediaDataRow::*error) {
  const std::vector<PlottedRow> rows = plottedRows(media, error);
  std::vector<PlotItem> items;
  for (const PlottedRow& row : rows) items.push_back(row.item);
  const Plot plot = layOutPlot(items, width, height, CostAxis::Logarithmic);
  View view;
  setPlotFrame(view, plot, size);
  const std::string path = marchPath(media, rows, plot);
  view.set("march", path.empty() ? View(false) : View(path));
  View marks = viewList();
  for (size_t i = 0; i < rows.size(); ++i) {
    const PlotMark& mark = plot.marks[i];
    View item;
    item.set("id", rowId(rows[i].row + 1));
    item.set("label", rows[i].item.label);
    item.set("title",
             fmt::format("{}: {} in {:.2f} ms", rows[i].item.label, share(rows[i].item.error), rows[i].item.costMs));
    item.set("shape", media.rows[rows[i].row].integrator == "march" ? "1" : "0");
    item.set("x", coordinate(mark.x));
    item.set("y", coordinate(mark.y));
    item.set("labelX", coordinate(mark.labelX));
    item.set("labelY", coordinate(mark.labelY));
    item.set("anchor", mark.anchor);
    item.set("onFront", mark.onFront);
    item.set("labelled", mark.labelled);
    marks.push_back(item);
  }
  view.set("marks", marks);
  return view;
}

View plotViews(const MediaData& media) {
  View list = viewList();
  for (const auto& [title, error] : {std::pair{"All pixels", &MediaDataRow::relRmse},
                                     {"The 99 % of the pixels that err least", &MediaDataRow::relRmse99}}) {
    View view, sizes = viewList();
    view.set("title", title);
    sizes.push_back(plotView(media, "wide", 980.0, 400.0, error));
    sizes.push_back(plotView(media, "narrow", 368.0, 380.0, error));
    view.set("sizes", sizes);
    list.push_back(view);
  }
  return list;
}

View edgeViews(const MediaData& media, ReportPictureShelf& shelf) {
  View list = viewList();
  for (const MediaDataRow& row : media.rows) {
    ReportPictures crops;
    for (const auto& [kind, path] : row.pictures)
      if (kind == "crop") crops.emplace_back(kind, path);
    const View pictures = pictureViews(crops, shelf);
    if (!pictures.is_non_empty_list()) continue;
    View view;
    view.set("name", row.name());
    view.set("pictures", pictures);
    list.push_back(view);
  }
  return list;
}

void setReference(View& page, const MediaData& media, const ReportData& data) {
  if (!media.reference) {
    page.set("reference", false);
    return;
  }
  const MediaDataReference& reference = *media.reference;
  const double pixels = static_cast<double>(data.width) * static_cast<double>(data.height);
  View view;
  view.set("mean", shortNumber(reference.mean));
  view.set("bound", share(reference.bound));
  view.set("worstChange", share(reference.worstChange));
  view.set("atLimit", reference.atLimit == 0 ? View(false) : View(grouped(reference.atLimit)));
  view.set("raysPerPixel", grouped(static_cast<uint64_t>(static_cast<double>(reference.rays) / pixels + 0.5)));
  view.set("doublings", std::to_string(reference.doublings));
  view.set("seconds", shortNumber(reference.traceMs / 1000.0));
  page.set("reference", view);
}

// "runs errs by 0.47 % ...": of the first row.
void setLead(View& page, const MediaData& media) {
  const MediaDataRow& first = media.rows.front();
  const MediaDataTerms* terms = findTerms(media, first.name(), true, "rel_rmse_99");
  page.set("leadName", first.name());
  page.set("leadId", rowId(1));
  page.set("leadError", first.relRmse ? View(share(*first.relRmse)) : View(false));
  // A bound says something where it lies on the side it bounds.
  const auto tells = [](const MediaDataFactor& factor) {
    return factor.bound == "exact" || (factor.factor >= 1.0) == (factor.bound == "at_least");
  };
  const bool both = terms != nullptr && tells(terms->faster) && tells(terms->better);
  page.set("leadFaster", both ? View(factorText(terms->faster)) : View(false));
  page.set("leadBetter", both ? View(factorText(terms->better)) : View(false));
}

}  // namespace

std::string mediaHtml(const std::filesystem::path& folder, const ReportData& data) {
  const MediaData& media = *data.media;
  GNOMON_CHECK(!media.rows.empty());
  ReportPictureShelf shelf(folder);
  View page;
  page.set("css", kPageCss);
  page.set("js", kPageJs);
  setFacts(page, data);
  setLead(page, media);
  View lights = viewList();
  for (const std::string& light : media.lights) lights.push_back(View(light));
  page.set("lights", lights);
  page.set("medium", fmt::format("σs {} and σa {} per metre, g {:.3g}, view rays end at {:.4g} m", media.sigmaS,
                                 media.sigmaA, media.g, media.reach));
  setReference(page, media, data);
  const View reference = media.reference ? pictureViews(media.reference->pictures, shelf) : viewList();
  page.set("referencePictures", reference);
  View rows = viewList();
  for (size_t i = 0; i < media.rows.size(); ++i) rows.push_back(rowView(media.rows[i], i + 1, media, data, shelf));
  page.set("rows", rows);
  const auto any = [&](std::optional<double> MediaDataRow::*value) {
    return std::ranges::any_of(media.rows, [&](const MediaDataRow& row) { return (row.*value).has_value(); });
  };
  page.set("hasErrors", any(&MediaDataRow::relRmse));
  page.set("hasFlicker", any(&MediaDataRow::flicker));
  const View terms = termsViews(media);
  page.set("terms", terms);
  page.set("hasTerms", terms.is_non_empty_list());
  page.set("plots", plotViews(media));
  const View edges = edgeViews(media, shelf);
  page.set("edges", edges);
  page.set("hasEdges", edges.is_non_empty_list());
  if (media.worst)
    page.set("edgePlace",
             fmt::format("the square of {} pixels at {}, {}", media.worst->size, media.worst->x, media.worst->y));
  View frames;
  if (media.frames) {
    frames.set("count", grouped(media.frames->count));
    frames.set("moves", media.frames->moves);
    frames.set("offset", media.frames->offset);
    frames.set("note", media.frames->note);
  }
  page.set("frames", media.frames ? frames : View(false));
  setMissing(page, shelf);
  kainjow::mustache::mustache pageTemplate{std::string(kMediaHtml)};
  GNOMON_CHECK(pageTemplate.is_valid());
  return pageTemplate.render(page);
}

}  // namespace gnomon
