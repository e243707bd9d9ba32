#include "lab/page/report_views.h"

#include "lab/page/report_text.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

std::string coordinate(double value) {
  return fmt::format("{:.1f}", value);
}

TemplateData viewList() {
  return TemplateData(TemplateData::type::list);
}

void setFacts(TemplateData& page, const ResultsHead& head) {
  const auto orNothing = [](const std::string& text) {
    return text.empty() ? TemplateData(false) : TemplateData(text);
  };
  page.set("version", head.program.version);
  page.set("interrupted", !head.isComplete);
  page.set("sceneName", head.scene.name.empty() ? "Unnamed scene" : head.scene.name);
  page.set("triangles", grouped(head.scene.triangles));
  page.set("sceneScale", shortNumber(shortest(head.scene.sceneScale)));
  page.set("camera", fmt::format("{} at {} m, {:.4g}° high", head.camera.name, vectorText(head.camera.eye),
                                 shortest(head.camera.fovDegrees)));
  page.set("width", std::to_string(head.camera.width));
  page.set("height", std::to_string(head.camera.height));
  page.set("device", head.program.device);
  page.set("driver", orNothing(head.program.driver));
  page.set("command", orNothing(head.program.command));
}

void setMissing(TemplateData& page, const ReportPictureShelf& shelf) {
  if (shelf.missing().empty()) {
    page.set("missing", false);
    return;
  }
  constexpr size_t kShown = 6;
  const std::vector<std::string>& paths = shelf.missing();
  std::string list = fmt::format("{}", fmt::join(paths.begin(), paths.begin() + std::min(kShown, paths.size()), ", "));
  if (paths.size() > kShown) list += fmt::format(" and {} more", paths.size() - kShown);
  TemplateData missing;
  missing.set("count", paths.size() == 1 ? "One picture" : fmt::format("{} pictures", paths.size()));
  missing.set("list", list);
  page.set("missing", missing);
}

std::string rowId(size_t rank) {
  return fmt::format("row-{}", rank);
}

TemplateData columnHead(const FieldNotes& notes) {
  TemplateData view;
  view.set("title", notes.title);
  return view;
}

TemplateData columnCell(const FieldNotes& notes, const std::optional<double>& value) {
  TemplateData view;
  view.set("title", notes.title);
  view.set("text", cellText(notes, value));
  view.set("raw", value ? rawNumber(*value) : "");
  view.set("strong", notes.ranks);
  return view;
}

TemplateData pictureViews(const Pictures& pictures, ReportPictureShelf& shelf) {
  TemplateData list = viewList();
  for (const auto& [kind, path] : pictures) {
    if (std::filesystem::path(path).extension() != ".png") continue;
    const std::optional<EmbeddedPicture> picture = shelf.embed(path, isShaded(kind));
    if (!picture) continue;
    TemplateData item;
    item.set("kind", kind);
    item.set("title", kindTitle(kind));
    item.set("image", picture->id);
    if (!picture->dataUri.empty()) item.set("src", picture->dataUri);
    item.set("imageWidth", std::to_string(picture->width));
    item.set("imageHeight", std::to_string(picture->height));
    list.push_back(item);
  }
  return list;
}

std::string idOf(const Pictures& pictures, const char* kind, ReportPictureShelf& shelf) {
  const auto found = std::ranges::find(pictures, kind, &Pictures::value_type::first);
  if (found == pictures.end()) return "";
  const std::optional<EmbeddedPicture> picture = shelf.embed(found->second, isShaded(kind));
  return picture ? picture->id : "";
}

TemplateData tickView(const PlotTick& tick, double tickEnd, double labelY) {
  TemplateData view;
  view.set("at", coordinate(tick.at));
  view.set("text", tick.text);
  view.set("tickEnd", coordinate(tickEnd));
  view.set("labelY", coordinate(labelY));
  return view;
}

void setPlotFrame(TemplateData& view, const Plot& plot, const char* size) {
  view.set("size", size);
  view.set("width", coordinate(plot.width));
  view.set("height", coordinate(plot.height));
  view.set("left", coordinate(plot.left));
  view.set("right", coordinate(plot.right));
  view.set("top", coordinate(plot.top));
  view.set("bottom", coordinate(plot.bottom));
  view.set("tickX", coordinate(plot.left - 7.0));
  view.set("costTitleY", coordinate(plot.height - 8.0));
  view.set("errorTitleX", "8");
  TemplateData errors = viewList();
  for (const PlotTick& tick : plot.errorTicks) errors.push_back(tickView(tick, 0.0, 0.0));
  TemplateData costs = viewList();
  for (const PlotTick& tick : plot.costTicks) costs.push_back(tickView(tick, plot.bottom + 5.0, plot.bottom + 18.0));
  view.set("errorTicks", errors);
  view.set("costTicks", costs);
  TemplateData zero;
  zero.set("at", coordinate(plot.zeroAt));
  zero.set("breakAt", coordinate(plot.zeroAt - 11.0));
  view.set("zero", plot.hasZero ? zero : TemplateData(false));
}

}  // namespace gnomon
