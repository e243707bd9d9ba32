#include "lab/page/report_rows.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace gnomon {

namespace {

struct Part {
  const char* kind;  // class of the style sheet
  const char* title;
  uint64_t ReportRow::*count;
};
constexpr Part kBarParts[] = {{"acne", "acne", &ReportRow::acne},
                              {"leak", "leak", &ReportRow::leak},
                              {"edge-shadow", "edge, shadow", &ReportRow::edgeShadow},
                              {"edge-light", "edge, light", &ReportRow::edgeLight}};

double shareOf(uint64_t count, const ReportRow& row) {
  return row.scored == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(row.scored);
}

std::string raw(double value) {
  return fmt::format("{}", value);
}

// Not of a knob that is named after its unit.
std::string knobUnit(const ReportRow& row, const ReportParam& knob) {
  const std::string& unit = row.tuning && row.tuning->knob == knob.name ? row.tuning->unit : knob.unit;
  return unit == knob.name ? "" : unit;
}

std::string withUnit(const std::string& value, const std::string& unit) {
  return unit.empty() ? value : value + "\u00a0" + unit;
}

std::string knobsText(const ReportRow& row) {
  std::string text;
  for (const ReportParam& param : row.params) {
    if (!param.isKnob) continue;
    const std::string value = withUnit(shortNumber(std::stod(param.text)), knobUnit(row, param));
    text += fmt::format("{}{}\u00a0{}", text.empty() ? "" : ", ", param.name, value);
  }
  return text;
}

void setBar(View& view, const ReportRow& row, double scale) {
  View parts = viewList();
  std::string words;
  double total = 0.0;
  for (const Part& part : kBarParts) {
    const uint64_t count = row.*part.count;
    if (count == 0) continue;
    const double share = shareOf(count, row);
    const std::string title = fmt::format("{}: {} ({})", part.title, grouped(count), percent(share));
    View item;
    item.set("kind", part.kind);
    item.set("title", title);
    item.set("percent", fmt::format("{:.3f}", 100.0 * std::min(share / scale, 1.0)));
    parts.push_back(item);
    words += (words.empty() ? "" : "; ") + title;
    total += share;
  }
  view.set("parts", parts);
  view.set("cut", total > scale * 1.0001);
  view.set("wrongText", words.empty() ? "none" : words);
  view.set("wrong", raw(static_cast<double>(row.acne + row.leak + row.edgeShadow + row.edgeLight)));
}

void setNumbers(View& view, const ReportRow& row) {
  const auto count = [&](const char* name, const char* rawName, uint64_t value) {
    view.set(name, grouped(value));
    view.set(rawName, raw(static_cast<double>(value)));
  };
  const auto milliseconds = [&](const char* name, const char* rawName, double value) {
    view.set(name, fmt::format("{:.2f}", value));
    view.set(rawName, raw(value));
  };
  const auto maybe = [&](const char* name, const char* rawName, const std::optional<double>& value) {
    view.set(name, value ? fmt::format("{:.4f}", *value) : "–");
    view.set(rawName, value ? raw(*value) : "");
  };
  view.set("biasError", percent(row.biasError));
  view.set("rawBiasError", raw(row.biasError));
  count("acne", "rawAcne", row.acne);
  count("leak", "rawLeak", row.leak);
  count("edgeShadow", "rawEdgeShadow", row.edgeShadow);
  count("edgeLight", "rawEdgeLight", row.edgeLight);
  count("uncovered", "rawUncovered", row.uncovered);
  maybe("rmse", "rawRmse", row.rmse);
  maybe("flip", "rawFlip", row.flip);
  milliseconds("buildMs", "rawBuildMs", row.buildMs);
  milliseconds("shadeMs", "rawShadeMs", row.shadeMs);
  milliseconds("frameMs", "rawFrameMs", row.frameMs);
}

void addPair(View& list, const std::string& key, const std::string& value) {
  View pair;
  pair.set("key", key);
  pair.set("value", value);
  list.push_back(pair);
}

View configurationView(const ReportRow& row) {
  View list = viewList();
  addPair(list, "bias", row.bias);
  addPair(list, "map",
          fmt::format("{}, {} × {} texels, {} layer{}", row.map, row.mapSize, row.mapSize, row.layers,
                      row.layers == 1 ? "" : "s"));
  addPair(list, "filter", row.filter);
  for (const ReportParam& param : row.params) {
    std::string name = param.name;
    std::ranges::replace(name, '_', ' ');
    addPair(list, name, param.isKnob ? withUnit(param.text, knobUnit(row, param)) : param.text);
  }
  return list;
}

View countsView(const ReportRow& row) {
  View list = viewList();
  const auto add = [&](const char* key, uint64_t count) {
    View item;
    item.set("key", key);
    item.set("value", grouped(count));
    item.set("share", percent(shareOf(count, row)));
    list.push_back(item);
  };
  add("scored", row.scored);
  add("agree", row.agree);
  for (const Part& part : kBarParts) add(part.title, row.*part.count);
  add("uncovered", row.uncovered);
  return list;
}

View tuningView(const ReportTuning& tuning) {
  View view;
  view.set("knob", tuning.knob);
  view.set("value", withUnit(shortNumber(tuning.value), tuning.unit));
  view.set("evaluations", grouped(tuning.evaluations));
  View list = viewList();
  for (const auto& elsewhere : {tuning.otherCamera, tuning.otherMapSize}) {
    if (!elsewhere) continue;
    View item;
    item.set("where", elsewhere->where);
    item.set("here", percent(elsewhere->biasError));
    item.set("best", percent(elsewhere->bestBiasError));
    item.set("bestValue", withUnit(shortNumber(elsewhere->bestValue), tuning.unit));
    list.push_back(item);
  }
  view.set("hasElsewhere", list.is_non_empty_list());
  view.set("elsewhere", list);
  return view;
}

View placesView(const ReportRow& row) {
  View list = viewList();
  const auto add = [&](const char* what, const std::optional<ReportPlace>& place) {
    if (!place) return;
    View item;
    item.set("what", what);
    item.set("x", std::to_string(place->x));
    item.set("y", std::to_string(place->y));
    item.set("size", std::to_string(place->size));
    item.set("pixels", grouped(place->pixels));
    item.set("area", grouped(static_cast<uint64_t>(place->size) * static_cast<uint64_t>(place->size)));
    list.push_back(item);
  };
  add("acne", row.worstAcne);
  add("leak", row.worstLeak);
  return list;
}

}  // namespace

View viewList() {
  return View(View::type::list);
}

std::string grouped(uint64_t count) {
  std::string digits = std::to_string(count);
  for (size_t at = digits.size(); at > 3;) digits.insert(at -= 3, "\u202f");  // narrow, and does not break
  return digits;
}

std::string percent(double fraction) {
  return fmt::format("{:.4f}\u202f%", 100.0 * fraction);
}

std::string shortNumber(double value) {
  return fmt::format("{:.4g}", value);
}

std::string kindTitle(const std::string& kind) {
  const size_t space = kind.find(' ');
  if (space != std::string::npos) return kindTitle(kind.substr(0, space)) + ", " + kind.substr(space + 1);
  if (kind == "truth") return "Exact shadow";
  if (kind == "truth_beauty") return "Shaded with the exact shadow";
  std::string title = kind;
  std::ranges::replace(title, '_', ' ');
  if (!title.empty()) title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

bool isShaded(const std::string& kind) {
  return kind == "medium" || kind.find("beauty") != std::string::npos;
}

View pictureViews(const ReportPictures& pictures, ReportPictureShelf& shelf) {
  View list = viewList();
  for (const auto& [kind, path] : pictures) {
    if (std::filesystem::path(path).extension() != ".png") continue;
    const std::optional<EmbeddedPicture> picture = shelf.embed(path, isShaded(kind));
    if (!picture) continue;
    View item;
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

View rowView(const ReportRow& row, size_t rank, const RowContext& context, ReportPictureShelf& shelf) {
  View view;
  view.set("id", rowId(rank));
  view.set("rank", std::to_string(rank));
  view.set("open", rank == 1);
  view.set("name", rowName(context.data, row));
  view.set("bias", row.bias);
  view.set("map", row.map);
  view.set("mapSize", std::to_string(row.mapSize));
  view.set("filter", row.filter);
  view.set("filtered", row.filter != "none");
  view.set("tuned", row.tuned);
  view.set("knobs", knobsText(row));
  setNumbers(view, row);
  setBar(view, row, context.barScale);
  View pictures = pictureViews(row.pictures, shelf);
  view.set("hasPictures", pictures.is_non_empty_list());
  view.set("pictures", pictures);
  if (!context.exact.visibility.empty()) view.set("truthVisibility", context.exact.visibility);
  if (!context.exact.beauty.empty()) view.set("truthBeauty", context.exact.beauty);
  view.set("places", placesView(row));
  view.set("params", configurationView(row));
  view.set("counts", countsView(row));
  view.set("tuning", row.tuning ? tuningView(*row.tuning) : View(false));
  view.set("rowCommand", row.command.empty() ? View(false) : View(row.command));
  return view;
}

std::string rowId(size_t rank) {
  return fmt::format("row-{}", rank);
}

std::string methodName(const ReportData& data, const ReportRow& row) {
  std::string name = row.bias;
  if (row.tuned) name += " tuned";
  const bool filtersDiffer =
      std::ranges::any_of(data.rows, [&](const ReportRow& other) { return other.filter != row.filter; });
  if (filtersDiffer && row.filter != "none") name += " " + row.filter;
  return name;
}

std::string rowName(const ReportData& data, const ReportRow& row) {
  const bool mapsDiffer = std::ranges::any_of(
      data.rows, [&](const ReportRow& other) { return other.map != row.map || other.mapSize != row.mapSize; });
  return methodName(data, row) + (mapsDiffer ? fmt::format(", {} {}", row.map, row.mapSize) : "");
}

}  // namespace gnomon
