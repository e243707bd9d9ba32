#include "lab/page/report_rows.h"

#include "lab/page/report_text.h"

#include <algorithm>

#include <fmt/format.h>

namespace gnomon {

namespace {

struct Part {
  const char* kind;  // class of the style sheet
  const char* title;
  size_t Row::*count;
};
constexpr Part kBarParts[] = {{"acne", "acne", &Row::acne},
                              {"leak", "leak", &Row::leak},
                              {"edge-shadow", "edge, shadow", &Row::edgeShadow},
                              {"edge-light", "edge, light", &Row::edgeLight}};

// A knob that is called by its unit has it in its name.
std::string unitBeside(const Row& row, const std::string& knob) {
  const std::string unit = row.unitOf(knob);
  return unit == knob ? "" : unit;
}

std::string withUnit(const std::string& value, const std::string& unit) {
  return unit.empty() ? value : value + "\u00a0" + unit;
}

std::string knobsText(const Row& row) {
  std::string text;
  for (const Param& param : row.params) {
    if (!row.isKnob(param)) continue;
    const std::string value = withUnit(shortNumber(std::get<double>(param.value)), unitBeside(row, param.name));
    text += fmt::format("{}{}\u00a0{}", text.empty() ? "" : ", ", param.name, value);
  }
  return text;
}

void setBar(TemplateData& view, const Row& row, double scale) {
  TemplateData parts = viewList();
  std::string words;
  double total = 0.0;
  for (const Part& part : kBarParts) {
    const size_t count = row.*part.count;
    if (count == 0) continue;
    const double share = row.shareOf(count);
    const std::string title = fmt::format("{}: {} ({})", part.title, grouped(count), percent(share));
    TemplateData item;
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
  view.set("wrong", std::to_string(row.acne + row.leak + row.edge()));
}

void addPair(TemplateData& list, const std::string& key, const std::string& value) {
  TemplateData pair;
  pair.set("key", key);
  pair.set("value", value);
  list.push_back(pair);
}

TemplateData configurationView(const Row& row) {
  TemplateData list = viewList();
  addPair(list, "bias", row.bias);
  addPair(list, "map",
          fmt::format("{}, {} × {} texels, {} slice{}", mapText(row.map, row.light), row.mapSide, row.mapSide,
                      row.layers, row.layers == 1 ? "" : "s"));
  addPair(list, "filter", row.filter);
  for (const Param& param : row.params) {
    std::string name = param.name;
    std::ranges::replace(name, '_', ' ');
    addPair(list, name, row.isKnob(param) ? withUnit(paramText(param), unitBeside(row, param.name)) : paramText(param));
  }
  return list;
}

TemplateData countsView(const Row& row) {
  TemplateData list = viewList();
  const auto add = [&](const char* key, size_t count) {
    TemplateData item;
    item.set("key", key);
    item.set("value", grouped(count));
    item.set("share", percent(row.shareOf(count)));
    list.push_back(item);
  };
  add("scored", row.scored);
  add("agree", row.agree);
  for (const Part& part : kBarParts) add(part.title, row.*part.count);
  if (row.unseenOccluder) add("of leak and edge: occluder named by no texel", *row.unseenOccluder);
  if (row.unseenSurface) add("of these: nor anything of its surface", *row.unseenSurface);
  add("uncovered", row.uncovered);
  return list;
}

// What the search minimized.
std::string minimized(double biasError, const std::optional<double>& rmse) {
  return rmse ? fmt::format("{:.4f}", *rmse) : percent(biasError);
}

TemplateData transferView(const std::string& where, const Transfer& transfer, const std::string& unit) {
  TemplateData view;
  view.set("where", where);
  view.set("here", minimized(transfer.biasError, transfer.rmse));
  view.set("best", minimized(transfer.bestBiasError, transfer.bestRmse));
  view.set("bestValue", withUnit(shortNumber(shortest(transfer.bestValue)), unit));
  return view;
}

TemplateData errorView(const std::string& where, const ErrorElsewhere& there) {
  TemplateData view;
  view.set("where", where);
  view.set("biasError", percent(there.biasError));
  view.set("allWrong", percent(there.allWrong));
  view.set("rmse", there.rmse ? fmt::format("{:.4f}", *there.rmse) : "–");
  return view;
}

TemplateData recommendedView(const Elsewhere& elsewhere) {
  TemplateData list = viewList();
  if (const auto& there = elsewhere.otherCamera)
    list.push_back(errorView(fmt::format("camera {}", there->camera), *there));
  if (const auto& there = elsewhere.otherMapSize)
    list.push_back(errorView(fmt::format("map of {0} × {0} texels", there->mapSize), *there));
  TemplateData view;
  view.set("places", list);
  return view;
}

TemplateData tuningView(const Row& row, const Tuning& tuning) {
  TemplateData view;
  view.set("least", row.isFiltered() ? "the least RMSE" : "the fewest acne and leak pixels");
  view.set("knob", tuning.knob);
  view.set("value", withUnit(shortNumber(shortest(tuning.value)), tuning.unit));
  view.set("evaluations", grouped(static_cast<uint64_t>(tuning.evaluations)));
  view.set("atEnd", tuning.atEnd.empty() ? TemplateData(false) : TemplateData(tuning.atEnd));
  TemplateData list = viewList();
  if (const auto& there = tuning.otherCamera)
    list.push_back(transferView(fmt::format("camera {}", there->camera), *there, tuning.unit));
  if (const auto& there = tuning.otherMapSize)
    list.push_back(transferView(fmt::format("map of {0} × {0} texels", there->mapSize), *there, tuning.unit));
  view.set("hasElsewhere", list.is_non_empty_list());
  view.set("elsewhere", list);
  return view;
}

TemplateData placesView(const Row& row) {
  TemplateData list = viewList();
  const auto add = [&](const char* what, const std::optional<WorstPlace>& place) {
    if (!place) return;
    TemplateData item;
    item.set("what", what);
    item.set("x", std::to_string(place->x));
    item.set("y", std::to_string(place->y));
    item.set("size", std::to_string(place->size));
    item.set("pixels", grouped(place->pixels.value_or(0)));
    item.set("area", grouped(static_cast<uint64_t>(place->size) * static_cast<uint64_t>(place->size)));
    list.push_back(item);
  };
  add("acne", row.worstAcne);
  add("leak", row.worstLeak);
  return list;
}

}  // namespace

TemplateData rowView(const Row& row, size_t number, const RowContext& context, ReportPictureShelf& shelf) {
  TemplateData view;
  view.set("id", rowId(number));
  view.set("rank", context.rank);
  view.set("open", number == 1);
  view.set("name", rowName(context.data, row));
  view.set("bias", row.bias);
  view.set("map", mapText(row.map, row.light));
  view.set("mapSize", row.mapDimensions);
  view.set("filter", row.filter);
  view.set("filtered", row.filter != "none");
  view.set("tuned", row.isTuned());
  view.set("crown", context.crown.empty() ? TemplateData(false) : TemplateData(context.crown));
  view.set("knobs", knobsText(row));
  view.set("biasError", percent(row.biasError()));
  view.set("rawBiasError", rawNumber(row.biasError()));
  view.set("allWrong", percent(row.allWrong()));
  view.set("rawAllWrong", rawNumber(row.allWrong()));
  view.set("cells", context.columns.cells(row));
  setBar(view, row, context.barScale);
  TemplateData pictures = pictureViews(row.pictures, shelf);
  view.set("hasPictures", pictures.is_non_empty_list());
  view.set("pictures", pictures);
  if (!context.exact.visibility.empty()) view.set("truthVisibility", context.exact.visibility);
  if (!context.exact.beauty.empty()) view.set("truthBeauty", context.exact.beauty);
  view.set("places", placesView(row));
  view.set("params", configurationView(row));
  view.set("counts", countsView(row));
  view.set("tuning", row.tuning ? tuningView(row, *row.tuning) : TemplateData(false));
  view.set("recommended", row.elsewhere ? recommendedView(*row.elsewhere) : TemplateData(false));
  view.set("rowCommand", row.command.empty() ? TemplateData(false) : TemplateData(row.command));
  return view;
}

std::string methodName(const Comparison& data, const Row& row) {
  std::string name = row.bias;
  if (row.isTuned()) name += " tuned";
  const bool filtersDiffer =
      std::ranges::any_of(data.rows, [&](const Row& other) { return other.filter != row.filter; });
  if (filtersDiffer && row.filter != "none") name += " " + row.filter;
  return name;
}

std::string rowName(const Comparison& data, const Row& row) {
  const bool mapsDiffer = std::ranges::any_of(data.rows, [&](const Row& other) {
    return other.map != row.map || other.light != row.light || other.mapDimensions != row.mapDimensions;
  });
  return methodName(data, row) +
         (mapsDiffer ? fmt::format(", {} {}", mapText(row.map, row.light), row.mapDimensions) : "");
}

}  // namespace gnomon
