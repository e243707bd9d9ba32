#include "lab/compare/method_row.h"

#include "judge/texel_density.h"
#include "lab/compare/row_pictures.h"
#include "lab/core/map_params.h"
#include "vsv/shadow_volume.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gnomon {

namespace {

// Knobs, then what the map holds and how it is drawn and fitted.
Params paramsOf(const Method& method, const Filter& filter, const Parameterization& map, const FittedMap& fitted,
                const CompareOptions& choice) {
  const BiasMethod& bias = *method.bias;
  Params params;
  for (const Knob& knob : knobsOf(bias)) params.push_back({knob.name, shortest(valueOf(method.params, bias, knob))});
  const ChosenFilter chosen = filterFor(choice, filter);
  for (size_t i = 0; i < filter.knobs.size(); ++i)
    params.push_back({filterParamName(filter.knobs[i].name), shortest(chosen.params.knobs[i])});
  for (const BiasChoice* way : bias.choices) params.push_back({way->name, way->text(method.params)});
  params.push_back({"map_content", contentName(bias.channels)});
  params.push_back({"cull", cullModeName(choice.cull)});
  for (const Param& param : mapParams(map, fitted, choice.mapOptions)) params.push_back(param);
  return params;
}

std::optional<Walks> walksOf(const WalkCounts& counts) {
  if (counts.walks == 0) return std::nullopt;
  const auto share = [&](int end) { return static_cast<double>(counts.ends[end]) / static_cast<double>(counts.walks); };
  return Walks{.count = counts.walks,
               .meanSteps = static_cast<double>(counts.steps) / static_cast<double>(counts.walks),
               .longest = static_cast<int>(counts.longest),
               .receiver = share(glsl::kWalkReceiver),
               .witness = share(glsl::kWalkWitness),
               .behind = share(glsl::kWalkBehind),
               .hole = share(glsl::kWalkHole),
               .open = share(glsl::kWalkOpen),
               .fold = share(glsl::kWalkFold),
               .aborted = counts.ends[glsl::kWalkAborted]};
}

void countLabels(Row& row, const LabelledResult& judged) {
  const LabelImage& labels = judged.labels;
  row.agree = labels.count(Label::Agree);
  row.acne = labels.count(Label::Acne);
  row.leak = labels.count(Label::Leak);
  row.edgeShadow = labels.count(Label::EdgeShadow);
  row.edgeLight = labels.count(Label::EdgeLight);
  row.uncovered = labels.count(Label::Uncovered);
  row.scored = row.agree + row.acne + row.leak + row.edgeShadow + row.edgeLight + row.uncovered;
  if (labels.unseen) row.unseenOccluder = labels.unseen->occluders;
  if (labels.unseen) row.unseenSurface = labels.unseen->surfaces;
  row.grazing = judged.grazing;
  row.edgeOn = judged.edgeOn.size();
  row.walks = walksOf(judged.walks);
}

bool isGiven(const CompareOptions& options, const BiasMethod& bias) {
  return std::ranges::any_of(options.knobs, [&](const KnobValue& value) { return hasKnob(bias, *value.knob); });
}

}  // namespace

std::string mapSizeText(const FittedMap& fitted) {
  const glsl::EpipolarGrid& grid = fitted.map.epipolar;
  if (fitted.map.kind != glsl::kMapEpipolar) return fmt::format("{}", fitted.map.width);
  return volumeSizeName({.alpha = grid.alphaCount, .theta = grid.thetaCount, .phi = grid.phiCount});
}

size_t mapBytes(const FittedMap& fitted, ChannelSet channels) {
  const glsl::EpipolarGrid& grid = fitted.map.epipolar;
  if (fitted.map.kind == glsl::kMapEpipolar) return size_t{1} * grid.alphaCount * grid.thetaCount * grid.phiCount / 8;
  return size_t{1} * fitted.map.width * fitted.map.height * fitted.map.sliceCount * bytesOf(completed(channels));
}

Row measuredRow(LightOnMap& lit, const Method& method, const LabelledResult& judged, const Filter& filter,
                const CompareOptions& options) {
  const FittedMap& fitted = lit.fitted();
  const BiasMethod& bias = *method.bias;
  Row row;
  row.map = lit.parameterization().name();
  row.light = lit.source().name;
  row.mapSide = fitted.map.width;
  row.layers = fitted.map.sliceCount;
  row.mapTexels = size_t{1} * fitted.map.width * fitted.map.height * fitted.map.sliceCount;
  row.mapBytes = mapBytes(fitted, bias.channels);
  row.mapDimensions = mapSizeText(fitted);
  row.isGiven = isGiven(options, bias);
  row.bias = bias.name;
  row.params = paramsOf(method, filter, lit.parameterization(), fitted, options);
  row.filter = filter.name;
  for (const Knob& knob : knobsOf(bias)) row.units.emplace_back(knob.name, unitName(knob.unit));
  for (const Knob& knob : filter.knobs) row.units.emplace_back(filterParamName(knob.name), unitName(knob.unit));
  countLabels(row, judged);
  row.worstAcne = findWorstPlace(judged.labels, lit.receivers().width, lit.receivers().height, Label::Acne);
  row.worstLeak = findWorstPlace(judged.labels, lit.receivers().width, lit.receivers().height, Label::Leak);
  return row;
}

std::optional<double> medianTexelWidth(const LightOnMap& lit) {
  constexpr size_t kTexelStride = 61;  // of the scored pixels one in so many
  if (!lit.parameterization().supportsFilters()) return std::nullopt;
  std::vector<double> widths;
  const Receivers& receivers = lit.receivers();
  size_t seen = 0;
  for (size_t i = 0; i < receivers.states.size(); ++i) {
    if (receivers.states[i] != PixelState::Scored || seen++ % kTexelStride != 0) continue;
    const auto density = texelDensity(lit.fitted(), receivers.samples[i].positionW, receivers.samples[i].normalW);
    if (density && *density > 0.0) widths.push_back(1.0 / std::sqrt(*density));
  }
  return widths.empty() ? std::nullopt : std::optional(median(widths));
}

}  // namespace gnomon
