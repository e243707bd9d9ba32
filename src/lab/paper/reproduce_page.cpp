#include "base/check.h"
#include "lab/compare/results.h"
#include "lab/page/report_page.h"
#include "lab/page/report_text.h"
#include "lab/page/report_views.h"
#include "lab/paper/reproduce.h"
#include "lab/paper/reproduce_style.h"

#include <array>

#include <fmt/format.h>

namespace gnomon {

namespace {

// Class of the style sheet.
const char* verdictKind(ClaimVerdict verdict) {
  constexpr std::array<const char*, 4> kKinds = {"holds", "partly", "not", "none"};
  return kKinds[static_cast<size_t>(verdict)];
}

TemplateData claimView(const JudgedClaim& judged, size_t index) {
  TemplateData view;
  view.set("index", std::to_string(index));
  view.set("kind", verdictKind(judged.verdict));
  view.set("verdict", verdictName(judged.verdict));
  view.set("figure", judged.claim.figure);
  view.set("says", judged.claim.says);
  view.set("run", judged.claim.run);
  TemplateData rule = viewList();
  for (size_t i = 0; i < judged.claim.conditions.size(); ++i) {
    TemplateData condition;
    condition.set("condition", judged.claim.conditions[i]);
    condition.set("broken", judged.conditions.empty() || !judged.conditions[i].holds);
    rule.push_back(condition);
  }
  view.set("rule", rule);
  std::string evidence;
  for (const auto& [name, value] : judged.numbers)
    evidence += fmt::format("{}{} = {}", evidence.empty() ? "" : ", ", name, numberText(value));
  view.set("evidence", judged.missing.empty() ? evidence : evidenceText(judged));
  return view;
}

TemplateData tallyView(const Reproduction& reproduction) {
  TemplateData list = viewList();
  for (const ClaimVerdict verdict :
       {ClaimVerdict::Holds, ClaimVerdict::HoldsInPart, ClaimVerdict::DoesNotHold, ClaimVerdict::NotRun}) {
    size_t count = 0;
    for (const JudgedClaim& judged : reproduction.claims) count += judged.verdict == verdict ? 1 : 0;
    if (count == 0 && verdict == ClaimVerdict::NotRun) continue;
    TemplateData view;
    view.set("count", std::to_string(count));
    view.set("kind", verdictKind(verdict));
    view.set("name", verdictName(verdict));
    list.push_back(view);
  }
  return list;
}

TemplateData pictureView(const std::string& path, bool asJpeg, const std::string& alt, ReportPictureShelf& shelf) {
  if (path.empty()) return TemplateData(false);
  const std::optional<EmbeddedPicture> picture = shelf.embed(path, asJpeg);
  // A picture that another panel holds already is not shown twice.
  if (!picture || picture->dataUri.empty()) return TemplateData(false);
  TemplateData view;
  view.set("src", picture->dataUri);
  view.set("width", std::to_string(picture->width));
  view.set("height", std::to_string(picture->height));
  view.set("alt", alt);
  return view;
}

TemplateData panelView(const Figure& figure, const Panel& panel, size_t index, ReportPictureShelf& shelf) {
  TemplateData view;
  view.set("id", figure.id);
  view.set("index", std::to_string(index));
  view.set("name", panel.name);
  view.set("what", panel.what);
  const auto orNothing = [](const std::string& text) {
    return text.empty() ? TemplateData(false) : TemplateData(text);
  };
  view.set("says", orNothing(panel.says));
  view.set("counts", orNothing(panel.counts));
  view.set("command", orNothing(panel.command));
  TemplateData pictures = viewList();
  const std::string alt = fmt::format("Figure {} ({}), ", figure.id, panel.name);
  const bool isShaded = panel.picture.find(".visibility.") == std::string::npos;
  const TemplateData shown = pictureView(panel.picture, isShaded, alt + (isShaded ? "shaded" : "visibility"), shelf);
  const TemplateData labels =
      pictureView(panel.labels, false, alt + (panel.counts.empty() ? "exact shadow" : "labels"), shelf);
  for (const TemplateData& picture : {shown, labels})
    if (!picture.is_false()) pictures.push_back(picture);
  view.set("pictures", pictures);
  view.set("sameLabels", !panel.labels.empty() && labels.is_false());
  return view;
}

TemplateData figureView(const Figure& figure, ReportPictureShelf& shelf) {
  TemplateData view;
  view.set("id", figure.id);
  view.set("title", figure.title);
  view.set("setup", figure.setup);
  view.set("svg", figure.svg.empty() ? TemplateData(false) : TemplateData(figure.svg));
  TemplateData panels = viewList();
  for (size_t i = 0; i < figure.panels.size(); ++i) panels.push_back(panelView(figure, figure.panels[i], i + 1, shelf));
  view.set("panels", panels);
  return view;
}

TemplateData cellsView(const std::vector<std::string>& texts) {
  TemplateData cells = viewList();
  for (size_t i = 0; i < texts.size(); ++i) {
    TemplateData cell;
    cell.set("text", texts[i]);
    cell.set("isNumber", i > 0);
    cells.push_back(cell);
  }
  return cells;
}

TemplateData tableView(const PaperTable& table, size_t index) {
  TemplateData view;
  view.set("index", std::to_string(index));
  view.set("id", table.id);
  view.set("title", table.title);
  view.set("note", table.note);
  view.set("columns", cellsView(table.columns));
  TemplateData rows = viewList();
  for (const std::vector<std::string>& texts : table.rows) {
    TemplateData row;
    row.set("cells", cellsView(texts));
    rows.push_back(row);
  }
  view.set("rows", rows);
  return view;
}

}  // namespace

std::string reproductionHtml(const Reproduction& reproduction, const ReproduceOptions& options,
                             const std::string& command) {
  ReportPictureShelf shelf(options.outDir);
  TemplateData page;
  page.set("css", kPageCss);
  page.set("ownCss", kReproduceCss);
  page.set("version", gnomonVersion());
  page.set("paper", reproduction.paper);
  page.set("citation", reproduction.citation);
  page.set("device", reproduction.device);
  page.set("scene", options.scene.empty() ? "generated, given with each figure" : options.scene);
  page.set("scale", fmt::format("{:g}", options.scale));
  page.set("scaledDown", options.scale != 1.0);
  page.set("seconds", fmt::format("{:.0f}", reproduction.seconds));
  page.set("command", command);
  page.set("tally", tallyView(reproduction));
  TemplateData leftOut = viewList();
  for (const LeftOut& left : reproduction.leftOut) {
    TemplateData view;
    view.set("what", left.what);
    view.set("why", left.why);
    leftOut.push_back(view);
  }
  page.set("leftOut", leftOut);
  TemplateData claims = viewList(), figures = viewList(), tables = viewList(), missing = viewList();
  for (size_t i = 0; i < reproduction.claims.size(); ++i) claims.push_back(claimView(reproduction.claims[i], i + 1));
  for (const Figure& figure : reproduction.figures) figures.push_back(figureView(figure, shelf));
  for (size_t i = 0; i < reproduction.tables.size(); ++i) tables.push_back(tableView(reproduction.tables[i], i + 1));
  for (const std::string& path : shelf.missing()) {
    TemplateData view;
    view.set("path", path);
    missing.push_back(view);
  }
  page.set("claims", claims);
  page.set("figures", figures);
  page.set("tables", tables);
  page.set("missing", missing);
  kainjow::mustache::mustache pageTemplate{std::string(kReproduceHtml)};
  GNOMON_CHECK(pageTemplate.is_valid());
  return pageTemplate.render(page);
}

}  // namespace gnomon
