#include "lab/page/media_page.h"

#include "base/check.h"
#include "lab/page/report_page.h"
#include "lab/page/report_text.h"
#include "lab/page/report_views.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

// "0.04" where it is grey, else "0.01, 0.02, 0.04".
std::string spectrumText(const glm::vec3& v) {
  return v.x == v.y && v.x == v.z ? shortNumber(shortest(v.x)) : vectorText(v);
}

std::string factorText(const Factor& factor) {
  const char* sign = factor.bound == Bound::AtLeast ? "≥ " : factor.bound == Bound::AtMost ? "≤ " : "";
  return fmt::format("{}{:.3g}", sign, factor.value);
}

bool hasErrors(const MediaResults& media) {
  return std::ranges::any_of(media.rows, [](const MediaRow& row) { return row.relRmse.has_value(); });
}

TemplateData pair(const std::string& key, const std::string& value) {
  TemplateData view;
  view.set("key", key);
  view.set("value", value);
  return view;
}

TemplateData paramViews(const MediaRow& row) {
  TemplateData list = viewList();
  list.push_back(pair("map", row.map));
  if (row.steps) list.push_back(pair("steps", std::to_string(*row.steps)));
  for (const Param& param : row.params) list.push_back(pair(param.name, paramText(param)));
  return list;
}

// Medium first: it is what the methods differ in.
TemplateData stockViews(const MediaRow& row, ReportPictureShelf& shelf) {
  Pictures pictures;
  for (const char* kind : {"medium", "beauty", "difference"})
    for (const auto& [name, path] : row.pictures)
      if (name == kind) pictures.emplace_back(name, path);
  return pictureViews(pictures, shelf);
}

TemplateData rowView(const MediaRow& row, size_t rank, const MediaResults& media, const PageColumns<MediaRow>& columns,
                     ReportPictureShelf& shelf) {
  TemplateData view;
  view.set("id", rowId(rank));
  view.set("rank", std::to_string(rank));
  view.set("open", rank == 1);
  view.set("name", row.name());
  view.set("map", row.map);
  view.set("score", hasErrors(media) ? cellText({.kind = NumberKind::Error}, row.relRmse)
                                     : fmt::format("{:.2f} ms", row.totalMs()));
  view.set("cells", columns.cells(row));
  view.set("width", std::to_string(media.camera.width));
  view.set("height", std::to_string(media.camera.height));
  const auto reference = [&](const char* name, const char* kind) {
    const std::string id = media.reference ? idOf(media.reference->pictures, kind, shelf) : "";
    view.set(name, id.empty() ? TemplateData(false) : TemplateData(id));
  };
  reference("exactMedium", "medium");
  reference("exactBeauty", "beauty");
  const TemplateData pictures = stockViews(row, shelf);
  view.set("pictures", pictures);
  view.set("hasPictures", pictures.is_non_empty_list());
  view.set("params", paramViews(row));
  return view;
}

// One line a method, with and without its builds.
TemplateData termsViews(const MediaResults& media) {
  TemplateData list = viewList();
  for (const MediaRow& row : media.rows) {
    for (const bool withBuild : {true, false}) {
      TemplateData view;
      view.set("method", row.name());
      view.set("counts", withBuild ? "map, table and integral" : "integration alone");
      bool any = false;
      for (const auto& [measure, faster, better] :
           {std::tuple{ErrorMeasure::RelRmse, "faster", "better"}, {ErrorMeasure::RelRmse99, "faster99", "better99"}}) {
        const EqualTerms* terms = findTerms(media.equalTerms, row.name(), withBuild, measure);
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

std::vector<PlottedRow> plottedRows(const MediaResults& media, std::optional<double> MediaRow::*error) {
  std::vector<PlottedRow> rows;
  for (size_t i = 0; i < media.rows.size(); ++i)
    if (const MediaRow& row = media.rows[i]; row.*error && row.totalMs() > 0.0)
      rows.push_back({i, {row.name(), row.totalMs(), *(row.*error)}});
  return rows;
}

// The baseline's marks, joined: one method at growing cost.
std::string baselinePath(const MediaResults& media, const std::vector<PlottedRow>& rows, const Plot& plot) {
  std::string path;
  size_t joined = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!media.rows[rows[i].row].isBaseline) continue;
    path += fmt::format("{}{:.1f} {:.1f}", joined++ == 0 ? "M" : "L", plot.marks[i].x, plot.marks[i].y);
  }
  return joined < 2 ? "" : path;
}

TemplateData plotView(const MediaResults& media, const char* size, double width, double height,
                      std::optional<double> MediaRow::*error) {
  const std::vector<PlottedRow> rows = plottedRows(media, error);
  std::vector<PlotItem> items;
  for (const PlottedRow& row : rows) items.push_back(row.item);
  const Plot plot = layOutPlot(items, width, height, CostAxis::Logarithmic);
  TemplateData view;
  setPlotFrame(view, plot, size);
  const std::string path = baselinePath(media, rows, plot);
  view.set("march", path.empty() ? TemplateData(false) : TemplateData(path));
  TemplateData marks = viewList();
  for (size_t i = 0; i < rows.size(); ++i) {
    const PlotMark& mark = plot.marks[i];
    TemplateData item;
    item.set("id", rowId(rows[i].row + 1));
    item.set("label", rows[i].item.label);
    item.set("title", fmt::format("{}: {} in {:.2f} ms", rows[i].item.label, errorText(rows[i].item.error),
                                  rows[i].item.costMs));
    item.set("shape", media.rows[rows[i].row].isBaseline ? "1" : "0");
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

TemplateData plotViews(const MediaResults& media) {
  TemplateData list = viewList();
  for (const auto& [title, error] :
       {std::pair{"All pixels", &MediaRow::relRmse}, {"Without the worst 1 % of the pixels", &MediaRow::relRmse99}}) {
    TemplateData view, sizes = viewList();
    view.set("title", title);
    sizes.push_back(plotView(media, "wide", 980.0, 400.0, error));
    sizes.push_back(plotView(media, "narrow", 368.0, 380.0, error));
    view.set("sizes", sizes);
    list.push_back(view);
  }
  return list;
}

TemplateData edgeViews(const MediaResults& media, ReportPictureShelf& shelf) {
  TemplateData list = viewList();
  for (const MediaRow& row : media.rows) {
    Pictures crops;
    for (const auto& [kind, path] : row.pictures)
      if (kind == "crop") crops.emplace_back(kind, path);
    const TemplateData pictures = pictureViews(crops, shelf);
    if (!pictures.is_non_empty_list()) continue;
    TemplateData view;
    view.set("name", row.name());
    view.set("pictures", pictures);
    list.push_back(view);
  }
  return list;
}

void setReference(TemplateData& page, const MediaResults& media) {
  if (!media.reference) {
    page.set("reference", false);
    return;
  }
  const ReferenceFacts& reference = *media.reference;
  const double pixels = static_cast<double>(media.camera.width) * static_cast<double>(media.camera.height);
  TemplateData view;
  view.set("mean", shortNumber(reference.mean));
  view.set("bound", errorText(reference.bound));
  view.set("worstChange", errorText(reference.worstChange));
  view.set("atLimit", reference.atLimit == 0 ? TemplateData(false) : TemplateData(grouped(reference.atLimit)));
  view.set("raysPerPixel", grouped(static_cast<uint64_t>(static_cast<double>(reference.rays) / pixels + 0.5)));
  view.set("doublings", std::to_string(reference.doublings));
  view.set("seconds", shortNumber(reference.traceMs / 1000.0));
  page.set("reference", view);
}

// "runs errs by 0.47 % ...": of the first row.
void setLead(TemplateData& page, const MediaResults& media) {
  const MediaRow& first = media.rows.front();
  const EqualTerms* terms = findTerms(media.equalTerms, first.name(), true, ErrorMeasure::RelRmse99);
  page.set("leadName", first.name());
  page.set("leadId", rowId(1));
  page.set("leadError", first.relRmse ? TemplateData(errorText(*first.relRmse)) : TemplateData(false));
  page.set("leadError99", first.relRmse99 ? TemplateData(errorText(*first.relRmse99)) : TemplateData(false));
  // A bound says something where it lies on the side it bounds.
  const auto tells = [](const Factor& factor) {
    return factor.bound == Bound::Exact || (factor.value >= 1.0) == (factor.bound == Bound::AtLeast);
  };
  const bool both = terms != nullptr && tells(terms->faster) && tells(terms->better);
  page.set("leadFaster", both ? TemplateData(factorText(terms->faster)) : TemplateData(false));
  page.set("leadBetter", both ? TemplateData(factorText(terms->better)) : TemplateData(false));
}

void setMedium(TemplateData& page, const MediaResults& media) {
  TemplateData lights = viewList();
  for (const LightFacts& light : media.lights)
    lights.push_back(TemplateData(
        fmt::format("{}, {} cd", lightText(light), spectrumText(light.intensity.value_or(glm::vec3(0.0f))))));
  page.set("lights", lights);
  page.set("medium", fmt::format("σs {} and σa {} per metre, g {:.3g}, view rays end at {:.4g} m",
                                 spectrumText(media.medium.sigmaS), spectrumText(media.medium.sigmaA),
                                 shortest(media.medium.g), shortest(media.medium.reach)));
}

void setRows(TemplateData& page, const MediaResults& media, ReportPictureShelf& shelf) {
  const PageColumns<MediaRow> columns(media.rows);
  TemplateData rows = viewList();
  for (size_t i = 0; i < media.rows.size(); ++i) rows.push_back(rowView(media.rows[i], i + 1, media, columns, shelf));
  page.set("columns", columns.heads());
  page.set("rows", rows);
  page.set("hasErrors", hasErrors(media));
  page.set("hasFlicker", std::ranges::any_of(media.rows, [](const MediaRow& row) { return row.flicker.has_value(); }));
}

void setEdges(TemplateData& page, const MediaResults& media, ReportPictureShelf& shelf) {
  const TemplateData edges = edgeViews(media, shelf);
  page.set("edges", edges);
  page.set("hasEdges", edges.is_non_empty_list());
  if (const std::optional<WorstPlace>& worst = media.worst)
    page.set("edgePlace", fmt::format("the square of {} pixels at {}, {}", worst->size, worst->x, worst->y));
}

void setFrames(TemplateData& page, const std::optional<FramesFacts>& frames, ReportPictureShelf& shelf) {
  page.set("framePictures", frames ? pictureViews(frames->pictures, shelf) : viewList());
  page.set("hasFramePictures", frames && !frames->pictures.empty());
  if (!frames) {
    page.set("frames", false);
    return;
  }
  TemplateData view;
  view.set("count", grouped(static_cast<uint64_t>(frames->count)));
  const std::string path = frames->degrees ? fmt::format("goes {:.4g}° round the axis {}", *frames->degrees,
                                                         vectorText(frames->axis.value_or(glm::vec3(0.0f))))
                           : frames->offset != glm::vec3(0.0f)
                               ? fmt::format("moves by {} m", vectorText(frames->offset))
                               : "changes";
  view.set("path", fmt::format("the {} {}", frames->moves, path));
  view.set("note", frames->note);
  page.set("frames", view);
}

}  // namespace

std::string mediaHtml(const std::filesystem::path& folder, const MediaResults& media) {
  GNOMON_CHECK(!media.rows.empty());
  ReportPictureShelf shelf(folder);
  TemplateData page;
  page.set("css", kPageCss);
  page.set("js", kPageJs);
  setFacts(page, media);
  setLead(page, media);
  setMedium(page, media);
  setReference(page, media);
  page.set("referencePictures", media.reference ? pictureViews(media.reference->pictures, shelf) : viewList());
  setRows(page, media, shelf);
  const TemplateData terms = termsViews(media);
  page.set("terms", terms);
  page.set("hasTerms", terms.is_non_empty_list());
  page.set("plots", plotViews(media));
  setEdges(page, media, shelf);
  setFrames(page, media.frames, shelf);
  setMissing(page, shelf);
  kainjow::mustache::mustache pageTemplate{std::string(kMediaHtml)};
  GNOMON_CHECK(pageTemplate.is_valid());
  return pageTemplate.render(page);
}

}  // namespace gnomon
