#include "lab/page/report_views.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gnomon {

std::string coordinate(double value) {
  return fmt::format("{:.1f}", value);
}

void setFacts(View& page, const ReportData& data) {
  page.set("version", data.version);
  page.set("sceneName", data.sceneName.empty() ? "Unnamed scene" : data.sceneName);
  page.set("triangles", grouped(data.triangles));
  page.set("sceneScale", shortNumber(data.sceneScale));
  std::string eye;
  for (const double x : data.cameraEye) eye += (eye.empty() ? "" : ", ") + shortNumber(x);
  page.set("camera", fmt::format("{} at {} m, {:.4g}° high", data.cameraName, eye, data.fovDegrees));
  page.set("width", std::to_string(data.width));
  page.set("height", std::to_string(data.height));
  page.set("device", data.device);
  page.set("driver", data.driver.empty() ? View(false) : View(data.driver));
  page.set("command", data.command.empty() ? View(false) : View(data.command));
}

void setMissing(View& page, const ReportPictureShelf& shelf) {
  if (shelf.missing().empty()) {
    page.set("missing", false);
    return;
  }
  constexpr size_t kShown = 6;
  const std::vector<std::string>& paths = shelf.missing();
  std::string list = fmt::format("{}", fmt::join(paths.begin(), paths.begin() + std::min(kShown, paths.size()), ", "));
  if (paths.size() > kShown) list += fmt::format(" and {} more", paths.size() - kShown);
  View missing;
  missing.set("count", paths.size() == 1 ? "One picture" : fmt::format("{} pictures", paths.size()));
  missing.set("list", list);
  page.set("missing", missing);
}

std::string idOf(const ReportPictures& pictures, const char* kind, ReportPictureShelf& shelf) {
  const auto found = std::ranges::find(pictures, kind, &ReportPictures::value_type::first);
  if (found == pictures.end()) return "";
  const std::optional<EmbeddedPicture> picture = shelf.embed(found->second, isShaded(kind));
  return picture ? picture->id : "";
}

View tickView(const PlotTick& tick, double tickEnd, double labelY) {
  View view;
  view.set("at", coordinate(tick.at));
  view.set("text", tick.text);
  view.set("tickEnd", coordinate(tickEnd));
  view.set("labelY", coordinate(labelY));
  return view;
}

void setPlotFrame(View& view, const Plot& plot, const char* size) {
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
  View errors = viewList();
  for (const PlotTick& tick : plot.errorTicks) errors.push_back(tickView(tick, 0.0, 0.0));
  View costs = viewList();
  for (const PlotTick& tick : plot.costTicks) costs.push_back(tickView(tick, plot.bottom + 5.0, plot.bottom + 18.0));
  view.set("errorTicks", errors);
  view.set("costTicks", costs);
  View zero;
  zero.set("at", coordinate(plot.zeroAt));
  zero.set("breakAt", coordinate(plot.zeroAt - 11.0));
  view.set("zero", plot.hasZero ? zero : View(false));
}

}  // namespace gnomon
