#include "lab/compare.h"

#include "base/error.h"
#include "base/progress.h"
#include "lab/pictures.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

TruthSummary summarize(const Parameterization& map, const Exact& exact) {
  return {.map = map.name(),
          .lightName = exact.source.name,
          .light = exact.light,
          .scored = exact.receivers.scored,
          .facingAway = exact.receivers.facingAway,
          .outsideCone = exact.receivers.outsideCone,
          .lit = exact.truth.litCount,
          .marginFlipsHalf = exact.truth.marginFlipsHalf,
          .marginFlipsDouble = exact.truth.marginFlipsDouble,
          .margin = exact.truth.margin};
}

Row rowFor(const Parameterization& map, const BiasMethod& bias, const glsl::BiasParams& params,
           const CompareOptions& options, const Judged& judged) {
  const LabelImage& labels = judged.labels;
  Row row;
  row.map = map.name();
  row.mapSide = mapSideOf(options, map);
  row.layers = map.layerCount(options.mapOptions);
  row.bias = bias.name;
  for (const BiasKnob& knob : bias.knobs) {
    row.knobs.emplace_back(knob.name, static_cast<double>(params.*knob.field));
    row.knobUnits.emplace_back(unitName(knob.unit));
  }
  // The three adaptive methods share one knob, which is adaptive's in the list.
  if (bias.hasEpsilon && bias.knobs.empty()) {
    row.knobs.emplace_back("k", static_cast<double>(params.adaptiveK));
    row.knobUnits.emplace_back("");
  }
  row.content = contentName(bias.content);
  row.cull = cullModeName(options.cull);
  row.mapOptions = options.mapOptions;
  if (bias.hasEpsilon) row.epsilonAt = epsilonAtName(params.epsilonAt);
  row.agree = labels.count(Label::Agree);
  row.acne = labels.count(Label::Acne);
  row.leak = labels.count(Label::Leak);
  row.edgeShadow = labels.count(Label::EdgeShadow);
  row.edgeLight = labels.count(Label::EdgeLight);
  row.uncovered = labels.count(Label::Uncovered);
  row.scored = row.agree + row.acne + row.leak + row.edgeShadow + row.edgeLight + row.uncovered;
  row.grazing = judged.grazing;
  row.edgeOn = judged.edgeOn;
  return row;
}

double rmseOf(const Exact& exact, const Judged& judged) {
  size_t wrong = 0;
  for (size_t i = 0; i < judged.verdicts.size(); ++i) {
    if (exact.receivers.states[i] != PixelState::Scored) continue;
    const bool lit = judged.verdicts[i] != Verdict::Shadow;
    if (lit != (exact.truth.lit[i] != 0)) ++wrong;
  }
  return std::sqrt(static_cast<double>(wrong) / static_cast<double>(exact.receivers.scored));
}

// EXR for data: the visibility predicted and true, and the label's number (Label in truth/labels.h).
ImageF dataImage(const Exact& exact, const Judged& judged) {
  ImageF image(exact.receivers.width, exact.receivers.height, 3);
  const std::vector<float> truth = truthVisibility(exact.receivers, exact.truth);
  for (size_t i = 0; i < truth.size(); ++i) {
    image.values[3 * i] = judged.visibility[i];
    image.values[3 * i + 1] = truth[i];
    image.values[3 * i + 2] = static_cast<float>(judged.labels.labels[i]);
  }
  return image;
}

void writeMapPictures(const Session& session, Passes& passes, const Exact& exact, const DrawnMap& map,
                      const std::filesystem::path& folder) {
  const std::vector<float> truth = truthVisibility(exact.receivers, exact.truth);
  const ImageF metres = depthInMetres(session, map);
  writePng(folder / "depth.png", depthPicture(metres));
  writeExr(folder / "depth.exr", metres, {"metres"});
  writePng(folder / "truth.png", visibilityPicture(exact.receivers, truth));
  writePng(folder / "truth.beauty.png", toSrgb8(renderRadiance(session, passes, exact, truth)));
}

void writeRowPictures(const Session& session, Passes& passes, const Exact& exact, const Judged& judged,
                      Row& row, const std::filesystem::path& outDir) {
  const std::string stem = row.map + "/" + row.bias;
  const std::string title = fmt::format("{} {}, {} x {} texels", row.map, row.bias, row.mapSide, row.mapSide);
  writePng(outDir / (stem + ".labels.png"), labelPicture(exact.receivers, exact.truth, judged.labels, title));
  writePng(outDir / (stem + ".visibility.png"), visibilityPicture(exact.receivers, judged.visibility));
  writePng(outDir / (stem + ".beauty.png"),
           toSrgb8(renderRadiance(session, passes, exact, judged.visibility)));
  writeExr(outDir / (stem + ".exr"), dataImage(exact, judged), {"visibility", "truth", "label"});
  row.pictures = {stem + ".labels.png", stem + ".visibility.png", stem + ".beauty.png", stem + ".exr"};
}

// Maps of one fit, by what they hold; drawn when first asked for.
class MapSet {
 public:
  MapSet(const Session& session, const MapRenderer& renderer, const FittedMap& fitted, const Exact& exact,
         CullMode cull)
      : session_(session), renderer_(renderer), fitted_(fitted), exact_(exact), cull_(cull) {}

  const DrawnMap& with(MapContent content) {
    const auto found = maps_.find(content);
    if (found != maps_.end()) return found->second;
    return maps_.emplace(content, drawMap(session_, renderer_, fitted_, exact_, content, cull_))
        .first->second;
  }

 private:
  const Session& session_;
  const MapRenderer& renderer_;
  const FittedMap& fitted_;
  const Exact& exact_;
  CullMode cull_;
  std::map<MapContent, DrawnMap> maps_;
};

// Rounds run one after another through all biases, so that a machine that slows down slows all of them.
void timeRows(const Session& session, Passes& passes, MapSet& maps, const Exact& exact,
              const CompareOptions& options, const glsl::BiasParams& params, std::span<Row> rows) {
  std::map<MapContent, std::vector<double>> build;
  std::vector<std::vector<double>> shade(rows.size());
  for (int round = -1; round < options.repeats;
       ++round) {  // round -1 warms up: pipelines compile at first use
    for (const BiasMethod* bias : options.biases) {
      std::vector<double>& times = build[bias->content];
      if (static_cast<int>(times.size()) > round + 1)
        continue;  // a map that another bias of this round had drawn
      times.push_back(redrawMap(session, passes.map, maps.with(bias->content), exact, options.cull));
    }
    for (size_t i = 0; i < rows.size(); ++i) {
      const BiasMethod& bias = *options.biases[i];
      const double shadeMs = timeVisibility(session, passes, maps.with(bias.content), exact, bias.id, params);
      if (round >= 0) shade[i].push_back(shadeMs);
    }
  }
  for (auto& [content, times] : build) times.erase(times.begin());  // the warm-up
  for (size_t i = 0; i < rows.size(); ++i) {
    rows[i].buildMs = median(build[options.biases[i]->content]);
    rows[i].shadeMs = median(shade[i]);
  }
}

}  // namespace

int mapSideOf(const CompareOptions& options, const Parameterization& map) {
  int side = options.mapSide;
  if (options.mapTexels != 0) {
    const double each = static_cast<double>(options.mapTexels) / map.layerCount(options.mapOptions);
    side = each >= 0.0 ? static_cast<int>(std::lround(std::min(std::sqrt(each), 1e6))) : 0;
  }
  if (side < 2 || side > 16384)
    throw UsageError(fmt::format(
        "a {} map's side of {} texels is outside 2..16384; choose another --map-size or --map-texels",
        map.name(), side));
  return side;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

glsl::BiasParams biasParams(const Session& session, const CompareOptions& options) {
  glsl::BiasParams params = defaultBiasParams(computeBounds(session.scene()).diagonal());
  params.epsilonAt = options.epsilonAt;
  for (const KnobValue& knob : options.knobs) params.*knob.knob->field = knob.value;
  return params;
}

ImageF depthInMetres(const Session& session, const DrawnMap& map) {
  const std::vector<float> depth = gpu::downloadAs<float>(session.device(), map.image->depth());
  const int side = map.fitted.map.side;
  ImageF metres(side * map.fitted.map.layerCount, side, 1);
  for (int layer = 0; layer < map.fitted.map.layerCount; ++layer) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const float d = depth[(static_cast<size_t>(layer) * side + y) * side + x];
        const glsl::Ray ray =
            glsl::mapTexelRay(map.fitted.map, layer, glsl::mapTexelCenter(map.fitted.map, {x, y}));
        // The texel ray's origin is at the near end; distances are told from the light (its plane, when
        // directional).
        const float nearEnd = map.fitted.map.mapLayers[layer].clipFromLight[2][3] != 0.0f
                                  ? glm::length(ray.origin)
                                  : -ray.origin.z;
        *metres.at(layer * side + x, y) = d >= 1.0f
                                              ? std::numeric_limits<float>::infinity()
                                              : nearEnd + glsl::mapDistance(map.fitted.map, layer, ray, d);
      }
    }
  }
  return metres;
}

Comparison compare(const Session& session, const CompareOptions& options) {
  Comparison comparison;
  std::vector<double> gbuffer;
  for (int i = 0; i < options.repeats; ++i) gbuffer.push_back(session.timeGBuffer());
  comparison.gbufferMs = median(gbuffer);

  Passes passes(session.device(), session.view());
  const glsl::BiasParams params = biasParams(session, options);
  Progress progress("compare", static_cast<int>(options.maps.size() * (options.biases.size() + 2)));
  for (const Parameterization* parameterization : options.maps) {
    progress.step(fmt::format("{}: exact shadow", parameterization->name()));
    const Clock::time_point start = Clock::now();
    const Exact exact = computeExact(session, *parameterization);
    TruthSummary summary = summarize(*parameterization, exact);
    summary.receiversAndTraceMs = std::chrono::duration<double, std::milli>(Clock::now() - start).count();

    progress.step(fmt::format("{}: map", parameterization->name()));
    const Fit fit =
        fitMap(session, *parameterization, exact, mapSideOf(options, *parameterization), options.mapOptions);
    MapSet maps(session, passes.map, fit.fitted, exact, options.cull);
    summary.zNear = fit.fitted.zNear;
    summary.zFar = fit.fitted.zFar;
    summary.fitNote = fit.fitted.note;
    summary.fitMs = fit.ms;
    comparison.truths.push_back(summary);
    if (!options.outDir.empty())
      writeMapPictures(session, passes, exact, maps.with(MapContent::OneLayer),
                       options.outDir / parameterization->name());

    const size_t firstRow = comparison.rows.size();
    for (const BiasMethod* bias : options.biases) {
      progress.step(fmt::format("{}: {}", parameterization->name(), bias->name));
      const Judged judged = judge(session, passes, maps.with(bias->content), exact, bias->id, params);
      Row row = rowFor(*parameterization, *bias, params, options, judged);
      row.rmse = rmseOf(exact, judged);
      if (!options.outDir.empty()) writeRowPictures(session, passes, exact, judged, row, options.outDir);
      comparison.rows.push_back(std::move(row));
    }
    timeRows(session, passes, maps, exact, options, params, std::span(comparison.rows).subspan(firstRow));
  }
  return comparison;
}

}  // namespace gnomon
